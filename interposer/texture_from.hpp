// Drawables that become textures: X pixmaps (GLX_EXT_texture_from_pixmap) and pbuffers (eglBindTexImage).
#pragma once

#include <GL/gl.h>

namespace mural {

struct ThreadState;
struct Window;

// The driver here has made the pixmap's picture the image of the texture bound to `target`: the nodes get
// it as an image.
void textureFromLocal(GLenum target, bool alpha);
// The nodes draw the pbuffer: its picture becomes the image of the 2D texture that is bound, now and whenever it
// was drawn to, until it is released. It is taken over when the program turns from the pbuffer to another drawable:
// what a texture shows while its pbuffer is being drawn to, EGL leaves open.
void bindDrawn(Window& w, bool alpha);
void releaseDrawn(Window& w);
// The thread is about to turn to another drawable, or to none.
void leavesDrawn(const ThreadState& t);
// The context is current, with drawables that are known: textures of it whose pbuffers were drawn to are brought up to date.
void refreshBoundTextures(ThreadState& t);

} // namespace mural
