// Implements the window manager of private displays. Source: ICCCM 4.1.2.4 (transients), 4.1.3.1 (WM_STATE), 4.1.5
// (replies to configure requests).
#include "nodes/launch/wall_window_manager.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace mural::launch {

namespace {

constexpr uint32_t kNormalState = 1; // ICCCM WM_STATE
constexpr uint32_t kWithdrawnState = 0;

template <class T> struct Freed {
    void operator()(T* p) const { std::free(p); }
};
template <class T> using Reply = std::unique_ptr<T, Freed<T>>;

} // namespace

Result<std::unique_ptr<WallWindowManager>> WallWindowManager::open(const std::string& display,
                                                                   const XAuthority::Cookie& cookie, int width,
                                                                   int height) {
    auto protocol = std::string(kXAuthorityProtocol);
    auto key = cookie;
    xcb_auth_info_t authority{};
    authority.name = protocol.data();
    authority.namelen = static_cast<int>(protocol.size());
    authority.data = reinterpret_cast<char*>(key.data());
    authority.datalen = static_cast<int>(key.size());
    xcb_connection_t* connection = xcb_connect_to_display_with_auth_info(display.c_str(), &authority, nullptr);
    if (xcb_connection_has_error(connection) != 0) {
        xcb_disconnect(connection);
        return Error{"the private display " + display + " accepts no connection; try again, or omit --size"};
    }
    std::unique_ptr<WallWindowManager> manager(new WallWindowManager(connection, width, height));
    if (!manager->takeRoot())
        return Error{"the private display " + display + " already has a window manager; try again"};
    return manager;
}

WallWindowManager::WallWindowManager(xcb_connection_t* connection, int width, int height)
    : connection_(connection), width_(width), height_(height) {}

WallWindowManager::~WallWindowManager() { xcb_disconnect(connection_); }

int WallWindowManager::fd() const { return xcb_get_file_descriptor(connection_); }

bool WallWindowManager::takeRoot() {
    root_ = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data->root;
    wmState_ = atom("WM_STATE");
    windowType_ = atom("_NET_WM_WINDOW_TYPE");
    mainKinds_ = {atom("_NET_WM_WINDOW_TYPE_NORMAL"), atom("_NET_WM_WINDOW_TYPE_DESKTOP")};
    const uint32_t events = XCB_EVENT_MASK_SUBSTRUCTURE_REDIRECT | XCB_EVENT_MASK_SUBSTRUCTURE_NOTIFY;
    const auto cookie = xcb_change_window_attributes_checked(connection_, root_, XCB_CW_EVENT_MASK, &events);
    return Reply<xcb_generic_error_t>(xcb_request_check(connection_, cookie)) == nullptr;
}

xcb_atom_t WallWindowManager::atom(const char* name) {
    const auto cookie = xcb_intern_atom(connection_, 0, static_cast<uint16_t>(std::strlen(name)), name);
    const Reply<xcb_intern_atom_reply_t> reply(xcb_intern_atom_reply(connection_, cookie, nullptr));
    return reply ? reply->atom : XCB_NONE;
}

bool WallWindowManager::dispatch() {
    while (const Reply<xcb_generic_event_t> event{xcb_poll_for_event(connection_)}) handle(*event);
    xcb_flush(connection_);
    return xcb_connection_has_error(connection_) == 0;
}

void WallWindowManager::handle(const xcb_generic_event_t& event) {
    const auto* bytes = reinterpret_cast<const void*>(&event);
    switch (event.response_type & 0x7f) {
    case XCB_MAP_REQUEST: mapRequested(*static_cast<const xcb_map_request_event_t*>(bytes)); break;
    case XCB_CONFIGURE_REQUEST: configureRequested(*static_cast<const xcb_configure_request_event_t*>(bytes)); break;
    case XCB_UNMAP_NOTIFY: {
        const auto window = static_cast<const xcb_unmap_notify_event_t*>(bytes)->window;
        setState(window, kWithdrawnState);
        windowGone(window);
        break;
    }
    case XCB_DESTROY_NOTIFY: windowGone(static_cast<const xcb_destroy_notify_event_t*>(bytes)->window); break;
    case XCB_REPARENT_NOTIFY: {
        const auto& moved = *static_cast<const xcb_reparent_notify_event_t*>(bytes);
        if (moved.parent != root_) windowGone(moved.window);
        break;
    }
    default: break;
    }
}

void WallWindowManager::mapRequested(const xcb_map_request_event_t& event) {
    const bool candidate = canBeMain(event.window);
    if (candidate && main_ == XCB_NONE) main_ = event.window;
    if (event.window == main_) {
        fillScreen(main_);
    } else if (candidate && std::find(waiting_.begin(), waiting_.end(), event.window) == waiting_.end()) {
        waiting_.push_back(event.window);
    }
    setState(event.window, kNormalState);
    xcb_map_window(connection_, event.window);
    if (event.window == main_) {
        xcb_set_input_focus(connection_, XCB_INPUT_FOCUS_POINTER_ROOT, main_, XCB_CURRENT_TIME);
    }
}

void WallWindowManager::configureRequested(const xcb_configure_request_event_t& event) {
    if (event.window == main_) {
        fillScreen(main_); // no-op if it fills the screen already; replies in both cases
        return;
    }
    const uint32_t all[] = {static_cast<uint32_t>(event.x),
                            static_cast<uint32_t>(event.y),
                            event.width,
                            event.height,
                            event.border_width,
                            event.sibling,
                            event.stack_mode};
    uint32_t values[7];
    int count = 0;
    for (int bit = 0; bit < 7; ++bit) {
        if ((event.value_mask >> bit & 1) != 0) values[count++] = all[bit];
    }
    xcb_configure_window(connection_, event.window, event.value_mask, values);
}

void WallWindowManager::windowGone(xcb_window_t window) {
    std::erase(waiting_, window);
    if (window != main_) return;
    main_ = XCB_NONE;
    if (waiting_.empty()) return;
    main_ = waiting_.front();
    waiting_.erase(waiting_.begin());
    fillScreen(main_);
    xcb_set_input_focus(connection_, XCB_INPUT_FOCUS_POINTER_ROOT, main_, XCB_CURRENT_TIME);
}

void WallWindowManager::fillScreen(xcb_window_t window) {
    const uint32_t values[] = {0, 0, static_cast<uint32_t>(width_), static_cast<uint32_t>(height_), 0};
    constexpr uint16_t kMask = XCB_CONFIG_WINDOW_X | XCB_CONFIG_WINDOW_Y | XCB_CONFIG_WINDOW_WIDTH |
                               XCB_CONFIG_WINDOW_HEIGHT | XCB_CONFIG_WINDOW_BORDER_WIDTH;
    xcb_configure_window(connection_, window, kMask, values);
    sendGeometry(window);
}

// A program that requested another size waits for a reply. The server only sends one after a change.
void WallWindowManager::sendGeometry(xcb_window_t window) {
    xcb_configure_notify_event_t notify{};
    notify.response_type = XCB_CONFIGURE_NOTIFY;
    notify.event = window;
    notify.window = window;
    notify.width = static_cast<uint16_t>(width_);
    notify.height = static_cast<uint16_t>(height_);
    char bytes[32] = {}; // SendEvent needs 32 bytes, even for shorter events
    static_assert(sizeof notify <= sizeof bytes);
    std::memcpy(bytes, &notify, sizeof notify);
    xcb_send_event(connection_, 0, window, XCB_EVENT_MASK_STRUCTURE_NOTIFY, bytes);
}

void WallWindowManager::setState(xcb_window_t window, uint32_t state) {
    const uint32_t value[] = {state, XCB_NONE};
    xcb_change_property(connection_, XCB_PROP_MODE_REPLACE, window, wmState_, wmState_, 32, 2, value);
}

bool WallWindowManager::canBeMain(xcb_window_t window) {
    const auto cookie = xcb_get_property(connection_, 0, window, XCB_ATOM_WM_TRANSIENT_FOR, XCB_ATOM_WINDOW, 0, 1);
    const Reply<xcb_get_property_reply_t> transient(xcb_get_property_reply(connection_, cookie, nullptr));
    if (transient && transient->type == XCB_ATOM_WINDOW && transient->value_len > 0) return false;
    return !isHelperKind(window);
}

bool WallWindowManager::isHelperKind(xcb_window_t window) {
    const auto cookie = xcb_get_property(connection_, 0, window, windowType_, XCB_ATOM_ATOM, 0, 32);
    const Reply<xcb_get_property_reply_t> kinds(xcb_get_property_reply(connection_, cookie, nullptr));
    if (!kinds || kinds->type != XCB_ATOM_ATOM || kinds->value_len == 0) return false;
    const auto* first = static_cast<const xcb_atom_t*>(xcb_get_property_value(kinds.get()));
    const auto* last = first + kinds->value_len;
    return std::none_of(first, last, [this](xcb_atom_t kind) {
        return std::find(mainKinds_.begin(), mainKinds_.end(), kind) != mainKinds_.end();
    });
}

} // namespace mural::launch
