// The range of vertices that an indexed draw reads.
#pragma once

#include <cstddef>
#include <cstdint>

#include <GL/gl.h>

namespace mural::sizes {

// min > max when there is no index (none at all, or only restarts).
struct IndexRange {
    uint32_t min = UINT32_MAX;
    uint32_t max = 0;
    bool any = false;
};

// indices: GL_UNSIGNED_BYTE, _SHORT or _INT, any alignment. restart: indices equal to restartIndex
// begin a new primitive and name no vertex; they are compared as 32-bit numbers, so that 0xffffffff
// never occurs among bytes (for GL_PRIMITIVE_RESTART_FIXED_INDEX see fixedRestartIndex).
IndexRange
scanIndices(const void* indices, GLenum type, size_t count, bool restart, uint32_t restartIndex);

// The largest number of the type, 0 when GL has no such index type.
uint32_t fixedRestartIndex(GLenum type);

} // namespace mural::sizes
