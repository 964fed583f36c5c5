#include "nodes/input/x_display.hpp"

#include <fstream>
#include <iterator>
#include <string>

namespace mural::input {

namespace {

constexpr const char* kCookieName = "MIT-MAGIC-COOKIE-1";

xcb_connection_t* openDisplay(const ProgramDisplay& display) {
    if (display.authority.empty()) return xcb_connect(display.name.c_str(), nullptr);
    std::ifstream file(display.authority, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::string cookie = cookieIn(bytes), name = kCookieName;
    xcb_auth_info_t auth{static_cast<int>(name.size()), name.data(), static_cast<int>(cookie.size()), cookie.data()};
    return xcb_connect_to_display_with_auth_info(display.name.c_str(), cookie.empty() ? nullptr : &auth, nullptr);
}

} // namespace

XConnection connectTo(const ProgramDisplay& display) {
    XConnection connection(openDisplay(display));
    if (connection && xcb_connection_has_error(connection.get()) != 0) connection.reset();
    return connection;
}

xcb_window_t rootOf(xcb_connection_t* connection) {
    return xcb_setup_roots_iterator(xcb_get_setup(connection)).data->root;
}

xcb_window_t largestWindow(xcb_connection_t* connection) {
    const xcb_window_t root = rootOf(connection);
    const Answer<xcb_query_tree_reply_t> tree(
        xcb_query_tree_reply(connection, xcb_query_tree(connection, root), nullptr));
    xcb_window_t largest = root;
    int64_t area = 0;
    for (int i = 0; tree && i < xcb_query_tree_children_length(tree.get()); ++i) {
        const xcb_window_t window = xcb_query_tree_children(tree.get())[i];
        const auto attributesCookie = xcb_get_window_attributes(connection, window);
        const auto geometryCookie = xcb_get_geometry(connection, window);
        const Answer<xcb_get_window_attributes_reply_t> attributes(
            xcb_get_window_attributes_reply(connection, attributesCookie, nullptr));
        const Answer<xcb_get_geometry_reply_t> geometry(xcb_get_geometry_reply(connection, geometryCookie, nullptr));
        if (!attributes || !geometry || attributes->map_state != XCB_MAP_STATE_VIEWABLE) continue;
        const int64_t size = int64_t{geometry->width} * geometry->height;
        if (size <= area) continue;
        area = size;
        largest = window;
    }
    return largest;
}

} // namespace mural::input
