// Drawables as textures: X pixmaps (GLX_EXT_texture_from_pixmap) and pbuffers (eglBindTexImage).
#pragma once

#include <GL/gl.h>

namespace mural {

struct ThreadState;
struct Window;

// Sends the picture of a pixmap to the nodes as an image. Call after the local driver has bound the pixmap to the
// texture of `target`.
void textureFromLocal(GLenum target, bool alpha);
// Makes the picture of a pbuffer, which the nodes draw, the image of the bound 2D texture, until it is released. Later
// draws change the image as well. It is updated when the program binds another drawable; EGL leaves the content
// undefined while the pbuffer is drawn to.
void bindDrawn(Window& w, bool alpha);
void releaseDrawn(Window& w);
// Call before the thread binds another drawable or none.
void beforeDrawableSwitch(const ThreadState& t);
// Updates the context's textures whose pbuffers were drawn to. Call when the context is current and its drawables are
// known.
void refreshBoundTextures(ThreadState& t);

} // namespace mural
