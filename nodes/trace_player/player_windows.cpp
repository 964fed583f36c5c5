#include "nodes/trace_player/player_windows.hpp"

#include <algorithm>

#include "common/base/clock.hpp"
#include "common/ipc/window_mark.hpp"

namespace mural {
namespace {

constexpr int64_t kXPatienceMs = 10'000;
constexpr uint32_t kMaxPixels = 32767; // per side, the limit of X

} // namespace

PlayerWindows::PlayerWindows(std::string title, const std::string& session)
    : title_(std::move(title)), sessionKey_(window_mark::sessionKey(session.c_str())) {}

Result<void> PlayerWindows::open() {
    if (x_) return {};
    auto opened = XConnection::open("", Deadline::inMs(kXPatienceMs));
    if (!opened) return opened.error();
    x_ = std::move(*opened);
    return {};
}

Result<uint32_t> PlayerWindows::make(const WindowOwner& owner, uint32_t width, uint32_t height) {
    const xcb_screen_t* screen = xcb_setup_roots_iterator(&x_->setup()).data;
    const xcb_window_t id = xcb_generate_id(x_->get());
    const uint32_t black = screen->black_pixel;
    const auto made =
        xcb_create_window_checked(x_->get(), XCB_COPY_FROM_PARENT, id, screen->root, 0, 0, static_cast<uint16_t>(width),
                                  static_cast<uint16_t>(height), 0, XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual,
                                  XCB_CW_BACK_PIXEL, &black);
    xcb_change_property(x_->get(), XCB_PROP_MODE_REPLACE, id, XCB_ATOM_WM_NAME, XCB_ATOM_STRING, 8,
                        static_cast<uint32_t>(title_.size()), title_.data());
    if (auto marked = markWindow(*x_, id, owner, Deadline::inMs(kXPatienceMs)); !marked) return marked.error();
    xcb_map_window(x_->get(), id);
    XOwned<xcb_generic_error_t> error;
    const XAnswer answer = x_->check(made, Deadline::inMs(kXPatienceMs), error);
    if (answer == XAnswer::Reply && !error) return id;
    if (error)
        return Error{"the X display " + x_->displayName() + " cannot create a window (error " +
                     std::to_string(error->error_code) + "); use --display none"};
    return x_->describe(answer);
}

Result<uint32_t> PlayerWindows::show(uint32_t client, uint32_t clientNow, uint32_t window, uint32_t width,
                                     uint32_t height) {
    if (auto r = open(); !r) return r.error();
    width = std::clamp(width, 1u, kMaxPixels);
    height = std::clamp(height, 1u, kMaxPixels);
    const auto found = windows_.find({client, window});
    if (found == windows_.end()) {
        auto made = make({sessionKey_, clientNow, window}, width, height);
        if (made) windows_[{client, window}] = *made;
        return made;
    }
    const uint32_t size[] = {width, height};
    xcb_configure_window(x_->get(), found->second, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, size);
    // The head's own connection must find the new size.
    if (const XAnswer answer = x_->awaitFence(x_->sendFence(), Deadline::inMs(kXPatienceMs)); answer != XAnswer::Reply)
        return x_->describe(answer);
    return found->second;
}

void PlayerWindows::destroy(uint32_t client, uint32_t window) {
    const auto found = windows_.find({client, window});
    if (found == windows_.end()) return;
    xcb_destroy_window(x_->get(), found->second);
    xcb_flush(x_->get());
    windows_.erase(found);
}

} // namespace mural
