// Copies from a framebuffer. The parts of a window on other nodes are first distributed to all nodes.
#pragma once

#include <GL/gl.h>

#include "interposer/context/thread_state.hpp"

namespace mural::copies {

// If a window is read, collects the planes of the rectangle from all nodes and sends them to all. Samples are resolved.
void gather(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes,
            const char* by = __builtin_FUNCTION());

// For glCopyPixels.
void gatherForPixels(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes,
                     const char* by = __builtin_FUNCTION());

// The same for a command that names the window, independent of the read binding. Not available in display lists.
void gatherNamed(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLbitfield planes,
                 const char* by = __builtin_FUNCTION());

// Makes every node draw the whole window from now on. Display lists that copy from a window or contain conditional
// rendering need this, because no request can interrupt them. Fragment shaders that write to memory and copies of
// samples need it as well.
void drawAll(ThreadState& t, const char* by = __builtin_FUNCTION());

// The planes that a copy reads into an image: of this format, or of a level of the bound or named texture.
GLbitfield planesOf(GLenum internalFormat);
GLbitfield planesOfBound(ThreadState& t, GLenum target, GLint level);
GLbitfield planesOfTexture(ThreadState& t, GLuint texture, GLint level);
GLbitfield planesOfTextureTarget(ThreadState& t, GLuint texture, GLenum target, GLint level);
GLbitfield planesOfUnit(ThreadState& t, GLenum unit, GLenum target, GLint level);

} // namespace mural::copies
