// Replaces the requests that grab and release an X server. A grab is recorded before its request is sent. The request
// waits until the head has shown all swapped frames, because the server then stops serving the head's connection. A
// release is flushed at once, because the head would wait for it otherwise.
#include "interposer/x11/server_grabs.hpp"

#include <X11/Xlib.h>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "interposer/context/context.hpp"
#include "interposer/entry/egl_displays.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/x11/next_function.hpp"
#include "interposer/x11/own_puts.hpp"
#include "interposer/x11/shown.hpp"

namespace mural {

namespace {

xcb_connection_t* connectionOf(Display* dpy) {
    static NextFunction next{"XGetXCBConnection", "libX11-xcb.so.1"};
    return dpy ? CallOf<xcb_connection_t*(Display*)>::call(next, dpy) : nullptr;
}
int descriptorOf(xcb_connection_t* c) {
    static NextFunction next{"xcb_get_file_descriptor", kXcb};
    return next.get() ? MURAL_CALL_OF(next, xcb_get_file_descriptor, c) : -1;
}
int descriptorOf(Display* dpy) {
    static NextFunction next{"XConnectionNumber", kXlib};
    return dpy && next.get() ? MURAL_CALL_OF(next, XConnectionNumber, dpy) : -1;
}

// A grab and its connection. The program may close the connection without a release. A changed socket inode reveals
// this.
struct Grab {
    int descriptor = -1;
    ino_t socket = 0;
    xcb_connection_t* connection = nullptr;
    Display* display = nullptr; // while the connection is unknown: libX11-xcb comes with the GL driver
};
constexpr int kMaxGrabs = 8; // limit of servers; an X server has one grab at a time
Grab grabs[kMaxGrabs];
int grabCount = 0; // read without the lock
Lock grabsLock;

ino_t socketOf(int descriptor) {
    struct stat about {};
    return descriptor >= 0 && fstat(descriptor, &about) == 0 && S_ISSOCK(about.st_mode) ? about.st_ino : 0;
}

// Requires the lock.
void removeAt(int index) {
    grabs[index] = grabs[grabCount - 1];
    __atomic_store_n(&grabCount, grabCount - 1, __ATOMIC_RELEASE);
}

void removeClosed() {
    for (int i = grabCount; i-- > 0;)
        if (socketOf(grabs[i].descriptor) != grabs[i].socket) removeAt(i);
}

void grabBegins(int descriptor, xcb_connection_t* connection, Display* display) {
    const ino_t socket = socketOf(descriptor);
    if (socket == 0) return;
    if (connection) forgetOwnPuts(connection);
    Guard guard(grabsLock);
    removeClosed();
    for (int i = 0; i < grabCount; ++i)
        if (grabs[i].descriptor == descriptor) return;
    if (grabCount == kMaxGrabs) return;
    grabs[grabCount] = {descriptor, socket, connection, display};
    __atomic_store_n(&grabCount, grabCount + 1, __ATOMIC_RELEASE);
}
void grabBegins(Display* dpy) { grabBegins(descriptorOf(dpy), connectionOf(dpy), dpy); }
void grabBegins(xcb_connection_t* c) { grabBegins(descriptorOf(c), c, nullptr); }

void grabEnds(int descriptor) {
    Guard guard(grabsLock);
    for (int i = grabCount; i-- > 0;)
        if (grabs[i].descriptor == descriptor) removeAt(i);
}

struct Peer {
    sockaddr_storage address{};
    socklen_t bytes = sizeof address;
    explicit Peer(int descriptor) {
        if (descriptor < 0 || getpeername(descriptor, reinterpret_cast<sockaddr*>(&address), &bytes) != 0) bytes = 0;
    }
    [[nodiscard]] bool isAs(const Peer& other) const {
        return bytes > 0 && bytes == other.bytes && std::memcmp(&address, &other.address, bytes) == 0;
    }
    // Returns whether this is the server of DISPLAY. EGL opens its own connection there if the program names no
    // display.
    [[nodiscard]] bool isDefault() const {
        const char* const name = getenv("DISPLAY");
        const char* const number = name ? std::strchr(name, ':') : nullptr;
        if (!number || address.ss_family != AF_UNIX || bytes == 0) return false;
        char path[sizeof(sockaddr_un::sun_path) + 1] = {};
        const auto& local = reinterpret_cast<const sockaddr_un&>(address);
        const size_t skipped = local.sun_path[0] == 0 ? 1 : 0; // an abstract name
        const size_t length = bytes - offsetof(sockaddr_un, sun_path);
        if (length <= skipped || length > sizeof local.sun_path) return false;
        std::memcpy(path, local.sun_path + skipped, length - skipped);
        const char* const file = std::strrchr(path, 'X');
        return file && std::atoi(file + 1) == std::atoi(number + 1);
    }
};

bool isServerOf(const Window& w, const Grab& grab) {
    const Peer server(grab.descriptor);
    if (!w.isEgl) return Peer(descriptorOf(static_cast<Display*>(w.display))).isAs(server);
    xcb_connection_t* const own = xConnectionOf(w.display);
    return own ? Peer(descriptorOf(own)).isAs(server) : server.isDefault();
}

} // namespace

xcb_connection_t* grabbingConnection(const Window& w) {
    if (__atomic_load_n(&grabCount, __ATOMIC_ACQUIRE) == 0 || w.native == 0) return nullptr;
    Guard guard(grabsLock);
    removeClosed();
    for (int i = 0; i < grabCount; ++i) {
        Grab& grab = grabs[i];
        if (!isServerOf(w, grab)) continue;
        if (!grab.connection) grab.connection = connectionOf(grab.display);
        return grab.connection;
    }
    return nullptr;
}

bool querySizeDuringGrab(const Window& w, uint32_t& width, uint32_t& height) {
    static NextFunction request{"xcb_get_geometry_unchecked", kXcb}, reply{"xcb_get_geometry_reply", kXcb};
    xcb_connection_t* const c = grabbingConnection(w);
    if (!c) return false;
    const auto cookie = MURAL_CALL_OF(request, xcb_get_geometry_unchecked, c, static_cast<xcb_drawable_t>(w.native));
    auto* const geometry = MURAL_CALL_OF(reply, xcb_get_geometry_reply, c, cookie, nullptr);
    if (!geometry) return false;
    width = geometry->width;
    height = geometry->height;
    std::free(geometry);
    return true;
}

} // namespace mural

using namespace mural;

#define GRAB(library, function, connection)                                                                            \
    static NextFunction next{#function, library};                                                                      \
    grabBegins(connection);                                                                                            \
    waitWindowsShown();                                                                                                \
    return callNext(next, function, connection)

MURAL_SHOWN int XGrabServer(Display* dpy) { GRAB(kXlib, XGrabServer, dpy); }
MURAL_SHOWN xcb_void_cookie_t xcb_grab_server(xcb_connection_t* c) { GRAB(kXcb, xcb_grab_server, c); }
MURAL_SHOWN xcb_void_cookie_t xcb_grab_server_checked(xcb_connection_t* c) { GRAB(kXcb, xcb_grab_server_checked, c); }

MURAL_SHOWN int XUngrabServer(Display* dpy) {
    static NextFunction next{"XUngrabServer", kXlib}, flush{"XFlush", kXlib};
    const int done = callNext(next, XUngrabServer, dpy);
    MURAL_CALL_OF(flush, XFlush, dpy);
    grabEnds(descriptorOf(dpy));
    return done;
}

#define UNGRAB(function, c)                                                                                            \
    static NextFunction next{#function, kXcb}, flush{"xcb_flush", kXcb};                                               \
    const xcb_void_cookie_t sent = callNext(next, function, c);                                                        \
    MURAL_CALL_OF(flush, xcb_flush, c);                                                                                \
    grabEnds(descriptorOf(c));                                                                                         \
    return sent

MURAL_SHOWN xcb_void_cookie_t xcb_ungrab_server(xcb_connection_t* c) { UNGRAB(xcb_ungrab_server, c); }
MURAL_SHOWN xcb_void_cookie_t xcb_ungrab_server_checked(xcb_connection_t* c) { UNGRAB(xcb_ungrab_server_checked, c); }
