#include "interposer/fronts/egl_displays.hpp"

#include <EGL/eglext.h>
#include <cstdlib>
#include <dlfcn.h>
#include <xcb/xcb.h>

#include "interposer/lock.hpp"

namespace mural {

namespace {

struct Known {
    EGLDisplay display = nullptr;
    xcb_connection_t* connection = nullptr;
};
constexpr int kMost = 16; // displays beyond are asked through EGL
Known known[kMost];
int count = 0;
Lock lock;

// From the copy that the program's EGL has brought with it; null: it has none.
template <class F> F* loaded(const char* library, const char* name) {
    void* handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
    return handle ? reinterpret_cast<F*>(dlsym(handle, name)) : nullptr;
}

// Threads may share it, as Mesa does; Xlib's own calls would need XInitThreads.
xcb_connection_t* connectionOf(EGLenum platform, void* native) {
    if (platform == EGL_PLATFORM_XCB_EXT) return static_cast<xcb_connection_t*>(native);
    if (platform != EGL_PLATFORM_X11_KHR) return nullptr;
    static auto* get = loaded<xcb_connection_t*(void*)>("libX11-xcb.so.1", "XGetXCBConnection");
    return get ? get(native) : nullptr;
}

xcb_connection_t* connectionOf(EGLDisplay display) {
    Guard guard(lock);
    for (int i = 0; i < count; ++i)
        if (known[i].display == display) return known[i].connection;
    return nullptr;
}

} // namespace

void rememberDisplay(EGLDisplay made, EGLenum platform, void* native) {
    xcb_connection_t* connection = made && native ? connectionOf(platform, native) : nullptr;
    if (!connection) return;
    Guard guard(lock);
    for (int i = 0; i < count; ++i) {
        if (known[i].display != made) continue;
        known[i].connection = connection;
        return;
    }
    if (count < kMost) known[count++] = {made, connection};
}

bool askXSize(EGLDisplay display, uint64_t window, uint32_t& width, uint32_t& height) {
    static auto* ask = loaded<xcb_get_geometry_cookie_t(xcb_connection_t*, xcb_drawable_t)>("libxcb.so.1", "xcb_get_geometry");
    static auto* answer = loaded<xcb_get_geometry_reply_t*(xcb_connection_t*, xcb_get_geometry_cookie_t, xcb_generic_error_t**)>("libxcb.so.1", "xcb_get_geometry_reply");
    xcb_connection_t* connection = ask && answer ? connectionOf(display) : nullptr;
    if (!connection) return false;
    xcb_generic_error_t* error = nullptr;
    xcb_get_geometry_reply_t* reply = answer(connection, ask(connection, static_cast<xcb_drawable_t>(window)), &error);
    std::free(error);
    if (!reply) return false;
    width = reply->width;
    height = reply->height;
    std::free(reply);
    return true;
}

} // namespace mural
