// Drawables that become textures: X pixmaps (GLX_EXT_texture_from_pixmap) and pbuffers (eglBindTexImage).
#pragma once

#include <GL/gl.h>

namespace mural {

struct Window;

// The driver here has made the pixmap's picture the image of the texture bound to `target`: the nodes get
// it as an image.
void textureFromLocal(GLenum target, bool alpha);
// The nodes have drawn the pbuffer: its picture becomes the image of the 2D texture that is bound.
void textureFromDrawn(Window& w, bool alpha);

} // namespace mural
