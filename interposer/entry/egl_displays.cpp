#include "interposer/entry/egl_displays.hpp"

#include <EGL/eglext.h>
#include <cstdlib>

#include "interposer/entry/xlib.hpp"
#include "interposer/context/lock.hpp"

namespace mural {

namespace {

struct Known {
    EGLDisplay display = nullptr;
    xcb_connection_t* connection = nullptr; // null: a platform other than X
};
constexpr int kMax = 16; // further displays are queried through EGL
Known known[kMax];
int count = 0;
Lock lock;

// Several threads may share an xcb connection, as Mesa does. Xlib's own calls would need XInitThreads.
xcb_connection_t* connectionOf(EGLenum platform, void* native) {
    if (platform == EGL_PLATFORM_XCB_EXT) return static_cast<xcb_connection_t*>(native);
    if (platform != EGL_PLATFORM_X11_KHR) return nullptr;
    static Loaded<xcb_connection_t*(void*)> function{"libX11-xcb.so.1", "XGetXCBConnection"};
    auto* get = function.get();
    return get ? get(native) : nullptr;
}

const Known* find(EGLDisplay display) {
    for (int i = 0; i < count; ++i)
        if (known[i].display == display) return &known[i];
    return nullptr;
}

bool isX(EGLenum platform) {
    return platform == EGL_NONE || platform == EGL_PLATFORM_X11_KHR || platform == EGL_PLATFORM_XCB_EXT;
}

} // namespace

xcb_connection_t* xConnectionOf(EGLDisplay display) {
    Guard guard(lock);
    const Known* found = find(display);
    return found ? found->connection : nullptr;
}

bool hasXWindows(EGLDisplay display) {
    Guard guard(lock);
    const Known* found = find(display);
    return !found || found->connection;
}

void rememberDisplay(EGLDisplay made, EGLenum platform, void* native) {
    xcb_connection_t* connection = made && native ? connectionOf(platform, native) : nullptr;
    if (!made || (!connection && isX(platform))) return;
    Guard guard(lock);
    for (int i = 0; i < count; ++i) {
        if (known[i].display != made) continue;
        known[i].connection = connection;
        return;
    }
    if (count < kMax) known[count++] = {made, connection};
}

void forgetConnection(xcb_connection_t* connection) {
    Guard guard(lock);
    for (int i = count; i-- > 0;)
        if (connection && known[i].connection == connection) known[i] = known[--count];
}

bool queryXSize(EGLDisplay display, uint64_t window, uint32_t& width, uint32_t& height) {
    static Loaded<xcb_get_geometry_cookie_t(xcb_connection_t*, xcb_drawable_t)> request{"libxcb.so.1",
                                                                                        "xcb_get_geometry"};
    static Loaded<xcb_get_geometry_reply_t*(xcb_connection_t*, xcb_get_geometry_cookie_t, xcb_generic_error_t**)>
        answering{"libxcb.so.1", "xcb_get_geometry_reply"};
    auto* getGeometry = request.get();
    auto* answer = answering.get();
    xcb_connection_t* connection = getGeometry && answer ? xConnectionOf(display) : nullptr;
    if (!connection) return false;
    xcb_generic_error_t* error = nullptr;
    xcb_get_geometry_reply_t* reply =
        answer(connection, getGeometry(connection, static_cast<xcb_drawable_t>(window)), &error);
    std::free(error);
    if (!reply) return false;
    width = reply->width;
    height = reply->height;
    std::free(reply);
    return true;
}

} // namespace mural
