// Copies out of a framebuffer: what of a window lies on other nodes is handed to all of them first.
#pragma once

#include <GL/gl.h>

#include "interposer/thread_state.hpp"

namespace mural::copies {

// Fetches the planes of the rectangle from all nodes and gives them to all, where a window is read. Samples come resolved.
void gather(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes, const char* by = __builtin_FUNCTION());

// Before glCopyPixels.
void gatherForPixels(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes, const char* by = __builtin_FUNCTION());

// The same for a command that names the window, whatever is bound for reading. Display lists hold none.
void gatherNamed(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes, const char* by = __builtin_FUNCTION());

// From now on every node draws all. For fragment shaders that write to memory, for a display list that copies out
// of a window, or draws on a condition that it finds itself: nobody can be asked in the middle of it; and for copies of samples.
void drawAll(ThreadState& t, const char* by = __builtin_FUNCTION());

// The planes that a copy into an image reads: of this format, of a level of the texture that is bound, or named.
GLbitfield planesOf(GLenum internalFormat);
GLbitfield planesOfBound(ThreadState& t, GLenum target, GLint level);
GLbitfield planesOfTexture(ThreadState& t, GLuint texture, GLint level);
GLbitfield planesOfTextureTarget(ThreadState& t, GLuint texture, GLenum target, GLint level);
GLbitfield planesOfUnit(ThreadState& t, GLenum unit, GLenum target, GLint level);

} // namespace mural::copies
