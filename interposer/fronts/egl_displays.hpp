// Which X connection an EGLDisplay stands for. eglQuerySurface asks the X server once for a window's width and once for
// its height; with the connection both come in one answer, in every frame.
#pragma once

#include <EGL/egl.h>
#include <cstdint>
#include <xcb/xcb.h>

struct xcb_connection_t;

namespace mural {

// eglGetDisplay and its kin have given `made` for this.
void rememberDisplay(EGLDisplay made, EGLenum platform, void* native);
// Null: not known. EGL_DEFAULT_DISPLAY has a connection of its own, which only the driver knows.
xcb_connection_t* xConnectionOf(EGLDisplay display);
// False: its native windows are those of another platform, such as Wayland or GBM.
bool hasXWindows(EGLDisplay display);
// It closes.
void forgetConnection(xcb_connection_t* connection);

// Null: it is not known, as EGL has opened it itself, or the display is not of X.
xcb_connection_t* xConnectionOf(EGLDisplay display);

// False where the connection is not known, or the server knows no such window.
bool askXSize(EGLDisplay display, uint64_t window, uint32_t& width, uint32_t& height);

} // namespace mural
