#include "tools/mural/page/input/cursor_watch.hpp"

#include <algorithm>
#include <chrono>
#include <sys/socket.h>
#include <vector>
#include <xcb/xfixes.h>

#include "common/base/clock.hpp"
#include "nodes/input/x_display.hpp"
#include "tools/mural/page/pictures/encode_picture.hpp"

namespace mural::page {

namespace {

constexpr std::chrono::milliseconds kLookEvery{33}, kOpenEvery{1000};
constexpr int64_t kWindowEveryNs = 500 * kNsPerMs; // the program may open another one, or resize it
constexpr size_t kMaxShapeSide = 256;

} // namespace

// A connection to one display.
struct CursorWatch::Eye {
    input::XConnection connection;
    xcb_window_t window = 0;
    bool isGiven = false, hasShapes = false;
    int width = 0, height = 0; // of the window
    int64_t windowNs = 0;
    uint8_t firstEvent = 0;
    CursorState state;

    static std::unique_ptr<Eye> open(const input::ProgramDisplay& display) {
        auto eye = std::make_unique<Eye>();
        eye->connection = input::connectTo(display);
        if (!eye->connection) return nullptr;
        eye->window = display.window;
        eye->isGiven = display.window != 0;
        eye->beginShapes();
        return eye;
    }

    void beginShapes() {
        const auto* extension = xcb_get_extension_data(connection.get(), &xcb_xfixes_id);
        if (extension == nullptr || extension->present == 0) return;
        const input::Answer<xcb_xfixes_query_version_reply_t> version(xcb_xfixes_query_version_reply(
            connection.get(), xcb_xfixes_query_version(connection.get(), 2, 0), nullptr));
        if (!version) return;
        hasShapes = true;
        firstEvent = extension->first_event;
        xcb_xfixes_select_cursor_input(connection.get(), input::rootOf(connection.get()),
                                       XCB_XFIXES_CURSOR_NOTIFY_MASK_DISPLAY_CURSOR);
        readShape();
    }

    void readShape() {
        const input::Answer<xcb_xfixes_get_cursor_image_reply_t> image(xcb_xfixes_get_cursor_image_reply(
            connection.get(), xcb_xfixes_get_cursor_image(connection.get()), nullptr));
        if (!image || image->width == 0 || image->height == 0 || image->width > kMaxShapeSide ||
            image->height > kMaxShapeSide)
            return;
        auto png = encodeCursorPng(xcb_xfixes_get_cursor_image_cursor_image(image.get()), image->width, image->height);
        if (!png) return;
        state.shape = std::make_shared<const std::string>(std::move(*png));
        state.width = image->width;
        state.height = image->height;
        state.hotX = image->xhot;
        state.hotY = image->yhot;
    }

    // Returns false if the connection is lost.
    bool look() {
        bool isNew = false;
        while (const input::Answer<xcb_generic_event_t> event{xcb_poll_for_event(connection.get())})
            isNew = isNew || (event->response_type & 0x7f) == firstEvent + XCB_XFIXES_CURSOR_NOTIFY;
        if (isNew && hasShapes) readShape();
        const int64_t nowNs = monotonicNowNs();
        if (windowNs == 0 || nowNs - windowNs > kWindowEveryNs) {
            windowNs = nowNs;
            if (!isGiven) window = input::largestWindow(connection.get());
            const input::Answer<xcb_get_geometry_reply_t> geometry(
                xcb_get_geometry_reply(connection.get(), xcb_get_geometry(connection.get(), window), nullptr));
            width = geometry ? geometry->width : 0;
            height = geometry ? geometry->height : 0;
        }
        const input::Answer<xcb_query_pointer_reply_t> pointer(
            xcb_query_pointer_reply(connection.get(), xcb_query_pointer(connection.get(), window), nullptr));
        state.isInside = pointer && width > 0 && height > 0 && pointer->win_x >= 0 && pointer->win_y >= 0 &&
                         pointer->win_x < width && pointer->win_y < height;
        const xcb_screen_t* const screen = xcb_setup_roots_iterator(xcb_get_setup(connection.get())).data;
        if (pointer) {
            state.displayX = std::clamp((pointer->root_x + 0.5) / screen->width_in_pixels, 0.0, 1.0);
            state.displayY = std::clamp((pointer->root_y + 0.5) / screen->height_in_pixels, 0.0, 1.0);
        }
        if (state.isInside) {
            state.x = (pointer->win_x + 0.5) / width;
            state.y = (pointer->win_y + 0.5) / height;
        }
        return xcb_connection_has_error(connection.get()) == 0;
    }
};

CursorWatch::CursorWatch(std::function<void(const CursorState& state)> onChange)
    : onChange_(std::move(onChange)), thread_([this] { work(); }) {}

CursorWatch::~CursorWatch() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        if (openFd_ >= 0) shutdown(openFd_, SHUT_RDWR); // a frozen X server must not keep this process
        changed_.notify_all();
    }
    thread_.join();
}

void CursorWatch::watch(std::optional<input::ProgramDisplay> display) {
    const std::lock_guard lock(mutex_);
    if (wanted_ == display) return;
    wanted_ = std::move(display);
    changed_.notify_all();
}

void CursorWatch::work() {
    std::unique_ptr<Eye> eye;
    std::optional<input::ProgramDisplay> of;
    CursorState told;
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (wanted_ != of || !wanted_) {
            openFd_ = -1;
            eye.reset();
            of = wanted_;
        }
        if (!of) {
            changed_.wait_for(lock, std::chrono::seconds(60));
            continue;
        }
        const input::ProgramDisplay display = *of;
        lock.unlock();
        if (!eye) eye = Eye::open(display);
        const bool isOpen = eye != nullptr;
        lock.lock();
        openFd_ = isOpen ? xcb_get_file_descriptor(eye->connection.get()) : -1;
        if (stop_) break;
        lock.unlock();
        const bool isFine = isOpen && eye->look();
        if (isFine && !(eye->state == told)) onChange_(told = eye->state);
        lock.lock();
        if (!isFine) {
            openFd_ = -1;
            eye.reset();
        }
        changed_.wait_for(lock, isFine ? kLookEvery : kOpenEvery);
    }
    openFd_ = -1;
}

} // namespace mural::page
