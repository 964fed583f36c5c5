#include "interposer/x11/gone_windows.hpp"

#include <cstdlib>
#include <xcb/xcbext.h>

#include "interposer/context/context.hpp"
#include "interposer/entry/egl_displays.hpp"
#include "interposer/entry/xlib.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/x11/next_function.hpp"
#include "interposer/x11/x_server.hpp"

namespace mural {

namespace gone_windows {
std::atomic<int> pending{0};
}

namespace {

struct Question {
    xcb_connection_t* connection = nullptr; // null: a free entry
    unsigned sequence = 0;
    uint64_t server = 0, native = 0;
};
constexpr int kMaxQuestions = 64; // further windows are skipped
Question questions[kMaxQuestions];
Lock lock; // guards all questions

struct Xcb {
    template <class F> static F* get(const char* name) { return loadedFunction<F>(kXcb, name); }
    decltype(&xcb_get_file_descriptor) socket = get<decltype(xcb_get_file_descriptor)>("xcb_get_file_descriptor");
    decltype(&xcb_get_window_attributes) request =
        get<decltype(xcb_get_window_attributes)>("xcb_get_window_attributes");
    decltype(&xcb_wait_for_reply) wait = get<decltype(xcb_wait_for_reply)>("xcb_wait_for_reply");
    decltype(&xcb_poll_for_reply) poll = get<decltype(xcb_poll_for_reply)>("xcb_poll_for_reply");
    decltype(&xcb_get_setup) setup = get<decltype(xcb_get_setup)>("xcb_get_setup");
    [[nodiscard]] bool complete() const { return socket && request && wait && poll && setup; }
};

// Returns null if the process has not loaded libxcb.
const Xcb* loadedXcb() {
    static const Xcb xcb;
    return xcb.complete() ? &xcb : nullptr;
}

xcb_connection_t* connectionOf(_XDisplay* display) {
    static auto* get = loadedFunction<xcb_connection_t*(_XDisplay*)>("libX11-xcb.so.1", "XGetXCBConnection");
    return get ? get(display) : nullptr;
}

bool isRequested(uint64_t server, uint64_t native) {
    for (const Question& q : questions)
        if (q.connection && q.server == server && q.native == native) return true;
    return false;
}

Question* freePlace() {
    for (Question& q : questions)
        if (!q.connection) return &q;
    return nullptr;
}

void forget(Question& q) {
    q = {};
    --gone_windows::pending;
}

} // namespace

void requestWindowAttributes(xcb_connection_t* connection) {
    if (!connection || !nextWindow(nullptr)) return;
    const Xcb* xcb = loadedXcb();
    const uint64_t server = xcb ? serverOf(xcb->socket(connection)) : 0;
    if (server == 0) return;
    Guard guard(lock);
    for (const Window* w = nextWindow(nullptr); w; w = nextWindow(w)) {
        if (!w->announced || !w->native || w->server != server || isRequested(server, w->native)) continue;
        Question* q = freePlace();
        if (!q) return;
        *q = {connection, xcb->request(connection, static_cast<xcb_window_t>(w->native)).sequence, server, w->native};
        ++gone_windows::pending;
    }
}

void requestWindowAttributes(_XDisplay* display) {
    if (nextWindow(nullptr)) requestWindowAttributes(connectionOf(display));
}

void checkForDestroyed(Window& w) {
    const Xcb* xcb = loadedXcb();
    xcb_connection_t* c = w.isEgl ? xConnectionOf(w.display) : connectionOf(static_cast<_XDisplay*>(w.display));
    if (!xcb || !c) return;
    xcb_generic_error_t* error = nullptr;
    void* reply = xcb->wait(c, xcb->request(c, static_cast<xcb_window_t>(w.native)).sequence, &error);
    if (reply) w.nativeGone = w.introduced = w.sizeKnown = false;
    std::free(reply);
    std::free(error);
}

void takeGoneWindows() {
    const Xcb* xcb = loadedXcb();
    if (!xcb) return;
    Guard guard(lock);
    for (Question& q : questions) {
        void* reply = nullptr;
        xcb_generic_error_t* error = nullptr;
        if (!q.connection || !xcb->poll(q.connection, q.sequence, &reply, &error)) continue;
        if (!reply && error) nativeWindowEnds(q.server, q.native);
        std::free(reply);
        std::free(error);
        forget(q);
    }
}

void connectionCloses(xcb_connection_t* connection) {
    {
        Guard guard(lock);
        for (Question& q : questions)
            if (connection && q.connection == connection) forget(q);
    }
    forgetConnection(connection);
    const Xcb* xcb = nextWindow(nullptr) ? loadedXcb() : nullptr;
    const xcb_setup_t* setup = xcb ? xcb->setup(connection) : nullptr;
    const uint64_t server = setup ? serverOf(xcb->socket(connection)) : 0;
    if (server != 0) nativeWindowsEnd(server, setup->resource_id_base, setup->resource_id_mask);
}

} // namespace mural
