#include "tools/mural/app_report/runs/window_picture.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <unistd.h>
#include <xcb/xcb.h>

#include "nodes/launch/child_process.hpp"
#include "nodes/output/files/png_files.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kAnswerMs = 3'000;
constexpr int kMaxWindowSide = 16'384;

template <class T> struct Freed {
    void operator()(T* p) const { std::free(p); }
};
template <class T> using Reply = std::unique_ptr<T, Freed<T>>;

xcb_connection_t* connect(const launch::PrivateDisplay& display) {
    auto protocol = std::string(launch::kXAuthorityProtocol);
    auto key = display.authority().cookie();
    xcb_auth_info_t authority{};
    authority.name = protocol.data();
    authority.namelen = static_cast<int>(protocol.size());
    authority.data = reinterpret_cast<char*>(key.data());
    authority.datalen = static_cast<int>(key.size());
    return xcb_connect_to_display_with_auth_info(display.name().c_str(), &authority, nullptr);
}

// Returns the largest visible child of the root, and its size.
xcb_window_t largestWindow(xcb_connection_t* c, xcb_window_t root, int& width, int& height) {
    const Reply<xcb_query_tree_reply_t> tree(xcb_query_tree_reply(c, xcb_query_tree(c, root), nullptr));
    if (!tree) return XCB_NONE;
    xcb_window_t best = XCB_NONE;
    const xcb_window_t* children = xcb_query_tree_children(tree.get());
    for (int i = 0; i < xcb_query_tree_children_length(tree.get()); ++i) {
        const Reply<xcb_get_window_attributes_reply_t> state(
            xcb_get_window_attributes_reply(c, xcb_get_window_attributes(c, children[i]), nullptr));
        const Reply<xcb_get_geometry_reply_t> place(
            xcb_get_geometry_reply(c, xcb_get_geometry(c, children[i]), nullptr));
        if (!state || !place || state->map_state != XCB_MAP_STATE_VIEWABLE) continue;
        if (place->width * place->height <= width * height) continue;
        best = children[i];
        width = place->width;
        height = place->height;
    }
    return best;
}

bool save(const launch::PrivateDisplay& display, const std::string& file) {
    xcb_connection_t* c = connect(display);
    if (xcb_connection_has_error(c) != 0) return false;
    const xcb_screen_t& screen = *xcb_setup_roots_iterator(xcb_get_setup(c)).data;
    int width = 0, height = 0;
    const xcb_window_t window = largestWindow(c, screen.root, width, height);
    if (window == XCB_NONE || width > kMaxWindowSide || height > kMaxWindowSide) return false;
    // Through the root, whose picture includes the children of the window.
    const Reply<xcb_translate_coordinates_reply_t> at(
        xcb_translate_coordinates_reply(c, xcb_translate_coordinates(c, window, screen.root, 0, 0), nullptr));
    if (!at) return false;
    const int left = std::max<int>(at->dst_x, 0), top = std::max<int>(at->dst_y, 0);
    width = std::min(width, screen.width_in_pixels - left);
    height = std::min(height, screen.height_in_pixels - top);
    if (width <= 0 || height <= 0) return false;
    const Reply<xcb_get_image_reply_t> image(xcb_get_image_reply(
        c,
        xcb_get_image(c, XCB_IMAGE_FORMAT_Z_PIXMAP, screen.root, static_cast<int16_t>(left), static_cast<int16_t>(top),
                      static_cast<uint16_t>(width), static_cast<uint16_t>(height), ~0u),
        nullptr));
    const size_t rowBytes = static_cast<size_t>(width) * kPictureBytesPerPixel;
    if (!image || xcb_get_image_data_length(image.get()) < static_cast<int>(rowBytes) * height) return false;
    OwnedPicture picture(width, height);
    const auto* bytes = reinterpret_cast<const std::byte*>(xcb_get_image_data(image.get()));
    for (int y = 0; y < height; ++y)
        std::copy_n(bytes + rowBytes * static_cast<size_t>(height - 1 - y), rowBytes, picture.row(y));
    return writePng(file, picture.view()).ok();
}

} // namespace

// A child process does it, because a reply of an X server has no time limit.
bool saveLargestWindow(const launch::PrivateDisplay& display, const std::string& file) {
    const pid_t pid = fork();
    if (pid == 0) _exit(save(display, file) ? 0 : 1);
    if (pid < 0) return false;
    launch::ChildProcess child = launch::ChildProcess::adopt(pid);
    if (!child.waitUntil(Deadline::inMs(kAnswerMs))) {
        child.end(Deadline::inMs(0));
        return false;
    }
    return child.exitStatus() == 0;
}

OwnedPicture reduced(const Picture& picture, int maxWidth) {
    const int step = std::max(1, (picture.width + maxWidth - 1) / maxWidth);
    OwnedPicture small(std::max(1, picture.width / step), std::max(1, picture.height / step));
    for (int y = 0; y < small.height(); ++y) {
        for (int x = 0; x < small.width(); ++x) {
            std::array<int, 4> sum{};
            int count = 0;
            for (int dy = 0; dy < step && y * step + dy < picture.height; ++dy) {
                const std::byte* from = picture.row(y * step + dy) + static_cast<size_t>(x * step) * 4;
                for (int dx = 0; dx < step && x * step + dx < picture.width; ++dx, ++count)
                    for (size_t k = 0; k < 4; ++k) sum[k] += static_cast<int>(from[static_cast<size_t>(dx) * 4 + k]);
            }
            for (size_t k = 0; k < 4; ++k)
                small.row(y)[static_cast<size_t>(x) * 4 + k] = static_cast<std::byte>(sum[k] / std::max(count, 1));
        }
    }
    return small;
}

} // namespace mural::cli
