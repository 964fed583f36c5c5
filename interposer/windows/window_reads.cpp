// Requests by which a program reads its windows, or copies between them and its pixmaps, through X: they
// wait for the pictures that are under way, then go on unchanged. The drawable is not looked at: a read
// of a parent or of the root window contains our windows as well, and an X id does not tell what it is.
// Grabbing the server waits, too: afterwards nobody else's picture would get through.
//
// These are names of libX11, libXext and libxcb. The preloaded library stands before them, so each is
// passed on to the next one in the program's own order; nothing is ever loaded.
#include <dlfcn.h>
#include <X11/Xlib.h>
#include <xcb/shm.h>
#include <xcb/xcb.h>

#include "interposer/windows/shown.hpp"

#define MURAL_SHOWN extern "C" __attribute__((visibility("default")))

namespace mural {

namespace {

constexpr const char* kXlib = "libX11.so.6";
constexpr const char* kXext = "libXext.so.6";
constexpr const char* kXcb = "libxcb.so.1";
constexpr const char* kXcbShm = "libxcb-shm.so.0";

struct NextFunction {
    const char* name;
    const char* library;
    void* found = nullptr;

    void* get() {
        if (void* known = __atomic_load_n(&found, __ATOMIC_RELAXED)) return known;
        // Stored, not returned: in a tail call glibc would look from our caller's place in the order.
        void* volatile next = dlsym(RTLD_NEXT, name);
        if (!next) { // the program has loaded the library out of everybody's sight
            void* handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
            if (handle) next = dlsym(handle, name);
            if (handle) dlclose(handle);
        }
        __atomic_store_n(&found, next, __ATOMIC_RELAXED);
        return next;
    }
};

// The result of a request that cannot be made because the process has no such library.
template <class Result> struct Nothing {
    static Result value() { return Result{}; }
};
template <> struct Nothing<void> {
    static void value() {}
};

// `like` names the function itself: its type is the next one's.
template <class Result, class... Parameters, class... Arguments>
Result passOn(NextFunction& next, Result (*like)(Parameters...), Arguments... arguments) {
    (void)like;
    waitWindowsShown();
    auto* call = reinterpret_cast<Result (*)(Parameters...)>(next.get());
    return call ? call(arguments...) : Nothing<Result>::value();
}

} // namespace

} // namespace mural

using namespace mural;

#define PASS_ON(library, function, ...)          \
    static NextFunction next{#function, library}; \
    return passOn(next, function, __VA_ARGS__)

// ---- Xlib

MURAL_SHOWN XImage* XGetImage(Display* dpy, Drawable d, int x, int y, unsigned w, unsigned h, unsigned long planes, int format) {
    PASS_ON(kXlib, XGetImage, dpy, d, x, y, w, h, planes, format);
}
MURAL_SHOWN XImage* XGetSubImage(Display* dpy, Drawable d, int x, int y, unsigned w, unsigned h, unsigned long planes, int format, XImage* into, int toX, int toY) {
    PASS_ON(kXlib, XGetSubImage, dpy, d, x, y, w, h, planes, format, into, toX, toY);
}
MURAL_SHOWN int XCopyArea(Display* dpy, Drawable from, Drawable to, GC gc, int x, int y, unsigned w, unsigned h, int toX, int toY) {
    PASS_ON(kXlib, XCopyArea, dpy, from, to, gc, x, y, w, h, toX, toY);
}
MURAL_SHOWN int XCopyPlane(Display* dpy, Drawable from, Drawable to, GC gc, int x, int y, unsigned w, unsigned h, int toX, int toY, unsigned long plane) {
    PASS_ON(kXlib, XCopyPlane, dpy, from, to, gc, x, y, w, h, toX, toY, plane);
}
MURAL_SHOWN int XGrabServer(Display* dpy) { PASS_ON(kXlib, XGrabServer, dpy); }

// As in X11/extensions/XShm.h, whose package is not needed for this one declaration.
MURAL_SHOWN Bool XShmGetImage(Display* dpy, Drawable d, XImage* image, int x, int y, unsigned long planes) {
    PASS_ON(kXext, XShmGetImage, dpy, d, image, x, y, planes);
}

// ---- xcb

MURAL_SHOWN xcb_get_image_cookie_t xcb_get_image(xcb_connection_t* c, uint8_t format, xcb_drawable_t d, int16_t x, int16_t y, uint16_t w, uint16_t h, uint32_t planes) {
    PASS_ON(kXcb, xcb_get_image, c, format, d, x, y, w, h, planes);
}
MURAL_SHOWN xcb_get_image_cookie_t xcb_get_image_unchecked(xcb_connection_t* c, uint8_t format, xcb_drawable_t d, int16_t x, int16_t y, uint16_t w, uint16_t h, uint32_t planes) {
    PASS_ON(kXcb, xcb_get_image_unchecked, c, format, d, x, y, w, h, planes);
}
MURAL_SHOWN xcb_void_cookie_t xcb_copy_area(xcb_connection_t* c, xcb_drawable_t from, xcb_drawable_t to, xcb_gcontext_t gc, int16_t x, int16_t y, int16_t toX, int16_t toY, uint16_t w, uint16_t h) {
    PASS_ON(kXcb, xcb_copy_area, c, from, to, gc, x, y, toX, toY, w, h);
}
MURAL_SHOWN xcb_void_cookie_t xcb_copy_area_checked(xcb_connection_t* c, xcb_drawable_t from, xcb_drawable_t to, xcb_gcontext_t gc, int16_t x, int16_t y, int16_t toX, int16_t toY, uint16_t w, uint16_t h) {
    PASS_ON(kXcb, xcb_copy_area_checked, c, from, to, gc, x, y, toX, toY, w, h);
}
MURAL_SHOWN xcb_void_cookie_t xcb_grab_server(xcb_connection_t* c) { PASS_ON(kXcb, xcb_grab_server, c); }
MURAL_SHOWN xcb_void_cookie_t xcb_grab_server_checked(xcb_connection_t* c) { PASS_ON(kXcb, xcb_grab_server_checked, c); }
MURAL_SHOWN xcb_shm_get_image_cookie_t xcb_shm_get_image(xcb_connection_t* c, xcb_drawable_t d, int16_t x, int16_t y, uint16_t w, uint16_t h, uint32_t planes, uint8_t format, xcb_shm_seg_t segment, uint32_t offset) {
    PASS_ON(kXcbShm, xcb_shm_get_image, c, d, x, y, w, h, planes, format, segment, offset);
}
MURAL_SHOWN xcb_shm_get_image_cookie_t xcb_shm_get_image_unchecked(xcb_connection_t* c, xcb_drawable_t d, int16_t x, int16_t y, uint16_t w, uint16_t h, uint32_t planes, uint8_t format, xcb_shm_seg_t segment, uint32_t offset) {
    PASS_ON(kXcbShm, xcb_shm_get_image_unchecked, c, d, x, y, w, h, planes, format, segment, offset);
}
