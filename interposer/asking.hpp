// Questions that only the render nodes can answer. Each is a round trip: counted under the name of the command that
// causes it, shown by the report and `mural stat`. Helpers hand `by` on, so that it is the wrapper's name.
#pragma once

#include <GL/gl.h>
#include <cstdint>

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural {

struct ThreadState;
struct Context;

// The rectangle of the current read framebuffer, tightly packed, put together from all nodes; in
// scratch memory of the thread. Null: no answer.
// how: flags of groupBytes (streamcodec/wire.hpp).
const void* askPixels(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format, GLenum type, uint32_t how = 0, const char* by = __builtin_FUNCTION());
void* askTexImage(ThreadState& t, bool byName, GLuint targetOrTexture, GLint level, GLenum format, GLenum type, uint64_t sizeBytes, const char* by = __builtin_FUNCTION());
bool askQuery(ThreadState& t, GLuint query, GLenum name, uint64_t& value, const char* by = __builtin_FUNCTION());
// Bytes of a buffer as the nodes have it; in scratch memory.
const void* askBuffer(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t sizeBytes, const char* by = __builtin_FUNCTION());
// What a program was linked from (docs/reference/wire-format.md); in scratch memory. Null: that can't be told.
const void* askProgram(ThreadState& t, GLuint program, uint64_t& sizeBytes, const char* by = __builtin_FUNCTION());
bool askFinish(ThreadState& t, const char* by = __builtin_FUNCTION());

// Runs `call` on the program's own context for its error alone: true when it raised none. The error
// is kept for the program's next glGetError.
template <class Call> bool raisesNothing(Context& c, Call&& call);
GLenum takeError(ThreadState& t); // for the program
GLenum driverError();
// A list that is executed as it is compiled may leave the driver in a primitive: then it has refused the call.
bool executesInPrimitive(const Context& c);
void stashError(Context& c, GLenum error);
// The session has ended before an answer came. The program's own GL has not drawn what was asked about, so the call
// writes nothing and raises GL_OUT_OF_MEMORY.
void answerLost(Context& c);

template <class Call> bool raisesNothing(Context& c, Call&& call) {
    stashError(c, driverError()); // the program's own, not asked for yet, comes first
    call();
    const GLenum error = driverError();
    stashError(c, error);
    return error == GL_NO_ERROR && !executesInPrimitive(c);
}

} // namespace mural
