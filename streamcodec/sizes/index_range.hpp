// The range of vertices that an indexed draw reads.
#pragma once

#include <cstddef>
#include <cstdint>

#include <GL/gl.h>

namespace mural::sizes {

// min > max if there is no index, or only restarts.
struct IndexRange {
    uint32_t min = UINT32_MAX;
    uint32_t max = 0;
    bool any = false;
};

// indices: GL_UNSIGNED_BYTE, _SHORT or _INT, any alignment. restart: indices equal to restartIndex start a new
// primitive and name no vertex. They are compared as 32-bit numbers, so 0xffffffff never matches a byte (for
// GL_PRIMITIVE_RESTART_FIXED_INDEX see fixedRestartIndex).
IndexRange scanIndices(const void* indices, GLenum type, size_t count, bool restart, uint32_t restartIndex);

// The maximum value of the type; 0: not an index type.
uint32_t fixedRestartIndex(GLenum type);

} // namespace mural::sizes
