// Replaces the X requests by which a program reads its windows, or copies between them and its pixmaps. They wait for
// pending pictures and then continue unchanged. They do not examine the drawable. A read of a parent or of the root
// window contains our windows as well, and an X id does not reveal its kind.
#include <X11/Xlib.h>
#include <xcb/shm.h>
#include <xcb/xcb.h>

#include "interposer/x11/next_function.hpp"
#include "interposer/x11/shown.hpp"

using namespace mural;

#define PASS_ON(wait, library, function, ...)                                                                          \
    static NextFunction next{#function, library};                                                                      \
    wait;                                                                                                              \
    return callNext(next, function, __VA_ARGS__)

// ---- Xlib

MURAL_SHOWN XImage* XGetImage(Display* dpy, Drawable d, int x, int y, unsigned w, unsigned h, unsigned long planes,
                              int format) {
    PASS_ON(waitBeforeRead(), kXlib, XGetImage, dpy, d, x, y, w, h, planes, format);
}
MURAL_SHOWN XImage* XGetSubImage(Display* dpy, Drawable d, int x, int y, unsigned w, unsigned h, unsigned long planes,
                                 int format, XImage* into, int toX, int toY) {
    PASS_ON(waitBeforeRead(), kXlib, XGetSubImage, dpy, d, x, y, w, h, planes, format, into, toX, toY);
}
MURAL_SHOWN int XCopyArea(Display* dpy, Drawable from, Drawable to, GC gc, int x, int y, unsigned w, unsigned h,
                          int toX, int toY) {
    PASS_ON(waitBeforeCopy(from), kXlib, XCopyArea, dpy, from, to, gc, x, y, w, h, toX, toY);
}
MURAL_SHOWN int XCopyPlane(Display* dpy, Drawable from, Drawable to, GC gc, int x, int y, unsigned w, unsigned h,
                           int toX, int toY, unsigned long plane) {
    PASS_ON(waitBeforeCopy(from), kXlib, XCopyPlane, dpy, from, to, gc, x, y, w, h, toX, toY, plane);
}

// Declared as in X11/extensions/XShm.h. That package is not needed for this one declaration.
MURAL_SHOWN Bool XShmGetImage(Display* dpy, Drawable d, XImage* image, int x, int y, unsigned long planes) {
    PASS_ON(waitBeforeRead(), kXext, XShmGetImage, dpy, d, image, x, y, planes);
}

// ---- xcb

MURAL_SHOWN xcb_get_image_cookie_t xcb_get_image(xcb_connection_t* c, uint8_t format, xcb_drawable_t d, int16_t x,
                                                 int16_t y, uint16_t w, uint16_t h, uint32_t planes) {
    PASS_ON(waitBeforeRead(), kXcb, xcb_get_image, c, format, d, x, y, w, h, planes);
}
MURAL_SHOWN xcb_get_image_cookie_t xcb_get_image_unchecked(xcb_connection_t* c, uint8_t format, xcb_drawable_t d,
                                                           int16_t x, int16_t y, uint16_t w, uint16_t h,
                                                           uint32_t planes) {
    PASS_ON(waitBeforeRead(), kXcb, xcb_get_image_unchecked, c, format, d, x, y, w, h, planes);
}
MURAL_SHOWN xcb_void_cookie_t xcb_copy_area(xcb_connection_t* c, xcb_drawable_t from, xcb_drawable_t to,
                                            xcb_gcontext_t gc, int16_t x, int16_t y, int16_t toX, int16_t toY,
                                            uint16_t w, uint16_t h) {
    PASS_ON(waitBeforeCopy(from), kXcb, xcb_copy_area, c, from, to, gc, x, y, toX, toY, w, h);
}
MURAL_SHOWN xcb_void_cookie_t xcb_copy_area_checked(xcb_connection_t* c, xcb_drawable_t from, xcb_drawable_t to,
                                                    xcb_gcontext_t gc, int16_t x, int16_t y, int16_t toX, int16_t toY,
                                                    uint16_t w, uint16_t h) {
    PASS_ON(waitBeforeCopy(from), kXcb, xcb_copy_area_checked, c, from, to, gc, x, y, toX, toY, w, h);
}
MURAL_SHOWN xcb_shm_get_image_cookie_t xcb_shm_get_image(xcb_connection_t* c, xcb_drawable_t d, int16_t x, int16_t y,
                                                         uint16_t w, uint16_t h, uint32_t planes, uint8_t format,
                                                         xcb_shm_seg_t segment, uint32_t offset) {
    PASS_ON(waitBeforeRead(), kXcbShm, xcb_shm_get_image, c, d, x, y, w, h, planes, format, segment, offset);
}
MURAL_SHOWN xcb_shm_get_image_cookie_t xcb_shm_get_image_unchecked(xcb_connection_t* c, xcb_drawable_t d, int16_t x,
                                                                   int16_t y, uint16_t w, uint16_t h, uint32_t planes,
                                                                   uint8_t format, xcb_shm_seg_t segment,
                                                                   uint32_t offset) {
    PASS_ON(waitBeforeRead(), kXcbShm, xcb_shm_get_image_unchecked, c, d, x, y, w, h, planes, format, segment, offset);
}
