// Maps each EGLDisplay to its X connection. eglQuerySurface queries the X server separately for a window's width and
// height. One query of the connection returns both, in every frame.
#pragma once

#include <EGL/egl.h>
#include <cstdint>
#include <xcb/xcb.h>

struct xcb_connection_t;

namespace mural {

// Records that eglGetDisplay or a similar function has returned `made` for this native display.
void rememberDisplay(EGLDisplay made, EGLenum platform, void* native);
// Returns null if the connection is unknown. The driver alone knows the connection of EGL_DEFAULT_DISPLAY.
xcb_connection_t* xConnectionOf(EGLDisplay display);
// Returns false for native windows of another platform, such as Wayland or GBM.
bool hasXWindows(EGLDisplay display);
// Call before the connection closes.
void forgetConnection(xcb_connection_t* connection);

// Returns null if EGL has opened the connection itself, or if the display does not belong to X.
xcb_connection_t* xConnectionOf(EGLDisplay display);

// Returns false if the connection is unknown, or the server has no such window.
bool queryXSize(EGLDisplay display, uint64_t window, uint32_t& width, uint32_t& height);

} // namespace mural
