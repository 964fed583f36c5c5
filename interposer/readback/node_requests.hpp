// Requests that only the render nodes can answer. Each is a round trip. The report and `mural stat` count it under the
// name of the command that causes it. Helpers pass `by` on, so it is the wrapper's name.
#pragma once

#include <GL/gl.h>
#include <cstdint>

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural {

struct ThreadState;
struct Context;

// Returns the rectangle of the current read framebuffer, tightly packed, combined from all nodes. The result is in
// scratch memory of the thread. Null: no reply. `how`: flags of groupBytes (streamcodec/wire/control_records.hpp).
const void* requestPixels(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format, GLenum type,
                          uint32_t how = 0, const char* by = __builtin_FUNCTION());
void* requestTexImage(ThreadState& t, bool byName, GLuint targetOrTexture, GLint level, GLenum format, GLenum type,
                      uint64_t sizeBytes, const char* by = __builtin_FUNCTION());
bool requestQuery(ThreadState& t, GLuint query, GLenum name, uint64_t& value, const char* by = __builtin_FUNCTION());
// Returns bytes of a buffer from the nodes, in scratch memory.
const void* requestBuffer(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t sizeBytes,
                          const char* by = __builtin_FUNCTION());
// Returns the recipe from which the nodes link a program (docs/reference/wire-format.md), in scratch memory. Null: the
// nodes cannot provide it.
const void* requestProgram(ThreadState& t, GLuint program, uint64_t& sizeBytes, const char* by = __builtin_FUNCTION());
bool requestFinish(ThreadState& t, const char* by = __builtin_FUNCTION());

// Runs `call` in the program's own context to learn its error. Returns true without an error. Otherwise the program's
// next glGetError returns the error.
template <class Call> bool raisesNothing(Context& c, Call&& call);
GLenum takeError(ThreadState& t); // for the program's glGetError
GLenum driverError();
// Returns true if the driver is inside a primitive of a compile-and-execute list. It has then rejected the call.
bool executesInPrimitive(const Context& c);
void stashError(Context& c, GLenum error);
// Call when the session ended before a reply arrived. The program's own GL has not drawn the requested data, so the
// call writes nothing. It raises GL_OUT_OF_MEMORY.
void answerLost(Context& c);

template <class Call> bool raisesNothing(Context& c, Call&& call) {
    stashError(c, driverError()); // an unqueried error of the program takes precedence
    call();
    const GLenum error = driverError();
    stashError(c, error);
    return error == GL_NO_ERROR && !executesInPrimitive(c);
}

} // namespace mural
