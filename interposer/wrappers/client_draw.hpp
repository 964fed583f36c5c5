// Sends vertex arrays in client memory before the draw that reads them.
#pragma once

#include <GL/gl.h>
#include <cstdint>

namespace mural {

struct ThreadState;
struct Context;

// Vertices first … last of the arrays, and `instances` instances from baseInstance.
struct VertexRange {
    int64_t first = 0;
    int64_t last = -1; // less than first: none
    uint32_t instances = 1;
    uint32_t baseInstance = 0;
};
void sendClientArrays(ThreadState& t, Context& c, const VertexRange& range);

// The range of the `count` indices at `indices` (client memory, or an offset into the element buffer), with baseVertex
// added.
VertexRange indexedRange(ThreadState& t, const Context& c, GLsizei count, GLenum type, const void* indices,
                         GLint baseVertex);

// The program's primitive restart index, or kNoRestart; without GL_PRIMITIVE_RESTART_FIXED_INDEX.
int64_t restartIndexOf(const Context& c);

GLint elementBufferBinding();

} // namespace mural
