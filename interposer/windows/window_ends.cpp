// X windows end without a word to GLX or EGL: the nodes are told when the program destroys one that it has
// drawn in, so that the wall turns to another. (The X server ends children with their parents: those go
// unnoticed until they are many.)
#include <X11/Xlib.h>
#include <xcb/xcb.h>

#include "interposer/context.hpp"
#include "interposer/windows/next_function.hpp"

using namespace mural;

#define END_AND_PASS_ON(library, function, connection, window) \
    static NextFunction next{#function, library};              \
    nativeWindowEnds(window);                                  \
    return callNext(next, function, connection, window)

MURAL_SHOWN int XDestroyWindow(Display* dpy, ::Window window) { END_AND_PASS_ON(kXlib, XDestroyWindow, dpy, window); }
MURAL_SHOWN xcb_void_cookie_t xcb_destroy_window(xcb_connection_t* c, xcb_window_t window) {
    END_AND_PASS_ON(kXcb, xcb_destroy_window, c, window);
}
MURAL_SHOWN xcb_void_cookie_t xcb_destroy_window_checked(xcb_connection_t* c, xcb_window_t window) {
    END_AND_PASS_ON(kXcb, xcb_destroy_window_checked, c, window);
}
