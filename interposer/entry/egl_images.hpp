// Images of GL objects (EGL 1.5 §3.9). Each node creates one from its own object. Images of other sources (pixmaps,
// dma-buf, Wayland buffers) exist on this machine only and are hidden from programs.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace mural {

EGLImage createImage(EGLDisplay dpy, EGLContext context, EGLenum target, EGLClientBuffer buffer,
                     const EGLAttrib* attributes);
EGLImageKHR createImageKhr(EGLDisplay dpy, EGLContext context, EGLenum target, EGLClientBuffer buffer,
                           const EGLint* attributes);
EGLBoolean destroyImage(EGLDisplay dpy, EGLImage image);
EGLBoolean destroyImageKhr(EGLDisplay dpy, EGLImageKHR image);

} // namespace mural
