#include "interposer/x11/own_puts.hpp"

#include <cstdlib>

#include "interposer/context/context.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/x11/next_function.hpp"
#include "interposer/x11/server_grabs.hpp"

namespace mural {

namespace {

// Calls a function of the libxcb that the program has loaded.
#define XCB(function, ...)                                                                                             \
    ([&] {                                                                                                             \
        static NextFunction next{#function, kXcb};                                                                     \
        return MURAL_CALL_OF(next, function, __VA_ARGS__);                                                             \
    }())

struct Target {
    xcb_window_t window = 0;
    xcb_connection_t* connection = nullptr;
    uint32_t depth = 0;
    uint32_t padBits = 0, bitsPerPixel = 0;
};
Target targets[capture::kOwnWindows]; // parallel to the header's slots
Lock targetsLock;                     // guards both
uint32_t nextSlot = 0;

const xcb_visualtype_t* visualOf(const xcb_setup_t* setup, xcb_visualid_t id) {
    for (auto screen = XCB(xcb_setup_roots_iterator, setup); screen.rem > 0; XCB(xcb_screen_next, &screen))
        for (auto depth = XCB(xcb_screen_allowed_depths_iterator, screen.data); depth.rem > 0;
             XCB(xcb_depth_next, &depth))
            for (auto visual = XCB(xcb_depth_visuals_iterator, depth.data); visual.rem > 0;
                 XCB(xcb_visualtype_next, &visual))
                if (visual.data->visual_id == id) return visual.data;
    return nullptr;
}

const xcb_format_t* formatOf(const xcb_setup_t* setup, uint8_t depth) {
    for (auto format = XCB(xcb_setup_pixmap_formats_iterator, setup); format.rem > 0; XCB(xcb_format_next, &format))
        if (format.data->depth == depth) return format.data;
    return nullptr;
}

// Queries the server, which answers the grabbing connection. Returns false for an unknown window or format.
bool readGeometry(xcb_connection_t* c, xcb_window_t window, Target& target, capture::OwnWindow& slot) {
    const auto attributesCookie = XCB(xcb_get_window_attributes_unchecked, c, window);
    const auto geometryCookie = XCB(xcb_get_geometry_unchecked, c, window);
    auto* const attributes = XCB(xcb_get_window_attributes_reply, c, attributesCookie, nullptr);
    auto* const geometry = XCB(xcb_get_geometry_reply, c, geometryCookie, nullptr);
    const xcb_setup_t* const setup = XCB(xcb_get_setup, c);
    const xcb_visualtype_t* const visual = setup && attributes ? visualOf(setup, attributes->visual) : nullptr;
    const xcb_format_t* const format = setup && geometry ? formatOf(setup, geometry->depth) : nullptr;
    const bool known = visual && format && setup->image_byte_order == XCB_IMAGE_ORDER_LSB_FIRST;
    if (known) {
        target = {window, c, geometry->depth, format->scanline_pad, format->bits_per_pixel};
        slot.depth = geometry->depth;
        slot.bitsPerPixel = format->bits_per_pixel;
        slot.rowPadBits = format->scanline_pad;
        slot.redMask = visual->red_mask;
        slot.greenMask = visual->green_mask;
        slot.blueMask = visual->blue_mask;
    }
    std::free(attributes);
    std::free(geometry);
    return known;
}

Target* find(xcb_window_t window) {
    for (Target& t : targets)
        if (t.window == window) return &t;
    return nullptr;
}

// Discards the errors of a checked request, which wait for xcb_request_check otherwise. The window may be gone.
void send(xcb_connection_t* c, xcb_void_cookie_t request) { XCB(xcb_discard_reply, c, request.sequence); }

} // namespace

bool announceOwnPut(capture::CaptureHeader& header, const Window& w, uint32_t frame) {
    xcb_connection_t* const c = grabbingConnection(w);
    if (!c) return false;
    const auto window = static_cast<xcb_window_t>(w.native);
    Guard guard(targetsLock);
    Target* target = find(window);
    if (!target || target->connection != c) {
        if (!target) target = &targets[nextSlot++ % capture::kOwnWindows];
        capture::OwnWindow& slot = header.ownWindows[target - targets];
        slot.window.store(0, std::memory_order_release);
        *target = {};
        if (!readGeometry(c, window, *target, slot)) return false;
    }
    capture::OwnWindow& slot = header.ownWindows[target - targets];
    slot.frame.store(frame, std::memory_order_relaxed);
    slot.window.store(window, std::memory_order_release);
    return true;
}

void forgetOwnPuts(xcb_connection_t* c) {
    Guard guard(targetsLock);
    for (Target& t : targets)
        if (t.connection == c) t.connection = nullptr;
}

void putOwnPicture(const wire::ReplyHeader& picture, const std::byte* pixels) {
    constexpr size_t kRequestBytes = 200 * 1024; // below the limit of servers without BIG-REQUESTS
    Target target;
    {
        Guard guard(targetsLock);
        const Target* const found = find(static_cast<xcb_window_t>(picture.x));
        if (found) target = *found;
    }
    if (!target.connection || picture.w <= 0 || picture.h <= 0 || picture.w > UINT16_MAX || picture.h > INT16_MAX)
        return;
    const size_t rowBits =
        (size_t(picture.w) * target.bitsPerPixel + target.padBits - 1) / target.padBits * target.padBits;
    const size_t rowBytes = rowBits / 8;
    if (rowBytes * size_t(picture.h) != picture.sizeBytes) return;
    xcb_connection_t* const c = target.connection;
    const xcb_gcontext_t gc = XCB(xcb_generate_id, c);
    const uint32_t values[] = {XCB_SUBWINDOW_MODE_CLIP_BY_CHILDREN, 0 /* no exposure events */};
    send(c,
         XCB(xcb_create_gc_checked, c, gc, target.window, XCB_GC_SUBWINDOW_MODE | XCB_GC_GRAPHICS_EXPOSURES, values));
    const int rows = static_cast<int>(kRequestBytes / rowBytes > 0 ? kRequestBytes / rowBytes : 1);
    for (int top = 0; top < picture.h; top += rows) {
        const int height = picture.h - top < rows ? picture.h - top : rows;
        send(c, XCB(xcb_put_image_checked, c, XCB_IMAGE_FORMAT_Z_PIXMAP, target.window, gc,
                    static_cast<uint16_t>(picture.w), static_cast<uint16_t>(height), 0, static_cast<int16_t>(top), 0,
                    static_cast<uint8_t>(target.depth), static_cast<uint32_t>(rowBytes * size_t(height)),
                    reinterpret_cast<const uint8_t*>(pixels + rowBytes * size_t(top))));
    }
    send(c, XCB(xcb_free_gc_checked, c, gc));
    XCB(xcb_flush, c);
}

} // namespace mural
