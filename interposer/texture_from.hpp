// Drawables as textures: X pixmaps (GLX_EXT_texture_from_pixmap) and pbuffers (eglBindTexImage).
#pragma once

#include <GL/gl.h>

namespace mural {

struct ThreadState;
struct Window;

// The driver here has bound a pixmap to the texture of `target`. Sends its picture to the nodes as an image.
void textureFromLocal(GLenum target, bool alpha);
// The nodes draw the pbuffer. Its picture becomes the image of the bound 2D texture, now and after later draws, until
// it is released. The image is updated when the program binds another drawable; EGL leaves the content undefined while
// the pbuffer is drawn to.
void bindDrawn(Window& w, bool alpha);
void releaseDrawn(Window& w);
// The thread is about to bind another drawable or none.
void leavesDrawn(const ThreadState& t);
// The context is current and its drawables are known: updates its textures whose pbuffers were drawn to.
void refreshBoundTextures(ThreadState& t);

} // namespace mural
