// Which X connection an EGLDisplay stands for. eglQuerySurface asks the X server once for a window's width and once for
// its height; with the connection both come in one answer, in every frame.
#pragma once

#include <EGL/egl.h>
#include <cstdint>

namespace mural {

// eglGetDisplay and its kin have given `made` for this; displays that are not of X are passed over.
void rememberDisplay(EGLDisplay made, EGLenum platform, void* native);

// False where the connection is not known, or the server knows no such window.
bool askXSize(EGLDisplay display, uint64_t window, uint32_t& width, uint32_t& height);

} // namespace mural
