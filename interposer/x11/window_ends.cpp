// Reports destroyed X windows, which GLX and EGL do not report. If the program destroys a window that it has drawn in,
// the nodes are notified, and the wall shows another window. Windows also end with their parent or their connection
// (gone_windows.hpp).
#include <X11/Xlib.h>
#include <xcb/xcb.h>

#include "interposer/context/context.hpp"
#include "interposer/entry/xlib.hpp"
#include "interposer/x11/gone_windows.hpp"
#include "interposer/x11/next_function.hpp"
#include "interposer/x11/x_server.hpp"

using namespace mural;

namespace {

uint64_t serverOf(Display* dpy) {
    static auto* socket = xlib<int(Display*)>("XConnectionNumber");
    return socket && dpy ? mural::serverOf(socket(dpy)) : 0;
}

uint64_t serverOf(xcb_connection_t* c) {
    static auto* socket = loadedFunction<int(xcb_connection_t*)>(kXcb, "xcb_get_file_descriptor");
    return socket && c ? mural::serverOf(socket(c)) : 0;
}

// GLX releases this thread's current context of the display. Contexts of other threads stay until their release.
void displayCloses(Display* dpy) {
    if (const Context* c = tThread->context; c && c->display == dpy) becameCurrent(nullptr, nullptr, nullptr);
    displayEnds(dpy, false);
}

void windowEnds(auto* connection, uint64_t window) {
    if (nextWindow(nullptr)) nativeWindowEnds(serverOf(connection), window);
}

} // namespace

#define PASS_ON_AND_CHECK(library, function, connection, resource)                                                     \
    static NextFunction next{#function, library};                                                                      \
    const auto result = callNext(next, function, connection, resource);                                                \
    requestWindowAttributes(connection);                                                                               \
    return result

#define END_AND_PASS_ON(library, function, connection, window)                                                         \
    windowEnds(connection, window);                                                                                    \
    PASS_ON_AND_CHECK(library, function, connection, window)

MURAL_SHOWN int XDestroyWindow(Display* dpy, ::Window window) { END_AND_PASS_ON(kXlib, XDestroyWindow, dpy, window); }
MURAL_SHOWN int XDestroySubwindows(Display* dpy, ::Window window) {
    PASS_ON_AND_CHECK(kXlib, XDestroySubwindows, dpy, window);
}
MURAL_SHOWN int XKillClient(Display* dpy, XID resource) { PASS_ON_AND_CHECK(kXlib, XKillClient, dpy, resource); }
MURAL_SHOWN int XCloseDisplay(Display* dpy) {
    static NextFunction next{"XCloseDisplay", kXlib};
    displayCloses(dpy);
    return callNext(next, XCloseDisplay, dpy);
}

MURAL_SHOWN xcb_void_cookie_t xcb_destroy_window(xcb_connection_t* c, xcb_window_t window) {
    END_AND_PASS_ON(kXcb, xcb_destroy_window, c, window);
}
MURAL_SHOWN xcb_void_cookie_t xcb_destroy_window_checked(xcb_connection_t* c, xcb_window_t window) {
    END_AND_PASS_ON(kXcb, xcb_destroy_window_checked, c, window);
}
MURAL_SHOWN xcb_void_cookie_t xcb_destroy_subwindows(xcb_connection_t* c, xcb_window_t window) {
    PASS_ON_AND_CHECK(kXcb, xcb_destroy_subwindows, c, window);
}
MURAL_SHOWN xcb_void_cookie_t xcb_destroy_subwindows_checked(xcb_connection_t* c, xcb_window_t window) {
    PASS_ON_AND_CHECK(kXcb, xcb_destroy_subwindows_checked, c, window);
}
MURAL_SHOWN xcb_void_cookie_t xcb_kill_client(xcb_connection_t* c, uint32_t resource) {
    PASS_ON_AND_CHECK(kXcb, xcb_kill_client, c, resource);
}
MURAL_SHOWN xcb_void_cookie_t xcb_kill_client_checked(xcb_connection_t* c, uint32_t resource) {
    PASS_ON_AND_CHECK(kXcb, xcb_kill_client_checked, c, resource);
}
MURAL_SHOWN void xcb_disconnect(xcb_connection_t* c) {
    static NextFunction next{"xcb_disconnect", kXcb};
    if (c) connectionCloses(c);
    callNext(next, xcb_disconnect, c);
}
