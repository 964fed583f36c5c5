#include "nodes/output/windows/redraw_request.hpp"

#include "nodes/output/windows/x_connection.hpp"

namespace mural {

Result<void> requestRedraw(const std::string& displayName, uint32_t window, Deadline deadline) {
    auto opened = XConnection::open(displayName, deadline);
    if (!opened) return opened.error();
    XConnection& x = **opened;
    XOwned<xcb_get_geometry_reply_t> geometry;
    const XAnswer answer = x.await(xcb_get_geometry(x.get(), window).sequence, deadline, &geometry);
    if (answer == XAnswer::Failed) return {}; // the window has just ended
    if (answer != XAnswer::Reply) return x.describe(answer);
    // The protocol copies 32 bytes of the event.
    union {
        xcb_expose_event_t expose;
        char bytes[32];
    } event{};
    event.expose.response_type = XCB_EXPOSE;
    event.expose.window = window;
    event.expose.width = geometry->width;
    event.expose.height = geometry->height;
    // A toolkit may listen at a window above.
    xcb_send_event(x.get(), 1, window, XCB_EVENT_MASK_EXPOSURE, event.bytes);
    const XAnswer sent = x.awaitFence(x.sendFence(), deadline);
    return sent == XAnswer::Reply ? Result<void>() : Result<void>(x.describe(sent));
}

} // namespace mural
