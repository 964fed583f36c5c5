// A connection to an X server with GLX, and the functions of libX11 and libGLX.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <GL/glx.h>
#include <GL/glxext.h>
#include <X11/Xlib.h>

#include "nodes/gl/config_match.hpp"
#include "nodes/gl/dynamic_library.hpp"

namespace mural::gl {

struct GlxFunctions {
    decltype(&XOpenDisplay) openDisplay = nullptr;
    decltype(&XCloseDisplay) closeDisplay = nullptr;
    decltype(&XDefaultScreen) defaultScreen = nullptr;
    decltype(&XFree) free = nullptr;
    decltype(&XGetErrorText) getErrorText = nullptr;
    decltype(&XSetErrorHandler) setErrorHandler = nullptr;
    decltype(&XSync) sync = nullptr;
    decltype(&glXCreatePbuffer) createPbuffer = nullptr;
    decltype(&glXDestroyContext) destroyContext = nullptr;
    decltype(&glXDestroyPbuffer) destroyPbuffer = nullptr;
    decltype(&glXGetFBConfigAttrib) getFbConfigAttrib = nullptr;
    decltype(&glXGetFBConfigs) getFbConfigs = nullptr;
    decltype(&glXGetCurrentContext) getCurrentContext = nullptr;
    decltype(&glXGetCurrentDrawable) getCurrentDrawable = nullptr;
    decltype(&glXGetCurrentReadDrawable) getCurrentReadDrawable = nullptr;
    decltype(&glXGetProcAddressARB) getProcAddress = nullptr;
    decltype(&glXMakeContextCurrent) makeContextCurrent = nullptr;
    decltype(&glXQueryDrawable) queryDrawable = nullptr;
    decltype(&glXQueryExtension) queryExtension = nullptr;
    decltype(&glXQueryExtensionsString) queryExtensionsString = nullptr;
    decltype(&glXQueryVersion) queryVersion = nullptr;
    PFNGLXCREATECONTEXTATTRIBSARBPROC createContextAttribs = nullptr;
};

// Owns the connection; used by one thread.
struct GlxDisplayState {
    GlxDisplayState() = default;
    GlxDisplayState(const GlxDisplayState&) = delete;
    GlxDisplayState& operator=(const GlxDisplayState&) = delete;
    ~GlxDisplayState();

    GlxFunctions glx;
    ::Display* display = nullptr;
    std::string name;
    int screen = 0;
    bool noConfigContext = false;
    bool esProfile = false;
    bool robust = false;
    bool flushControl = false;               // contexts can be created without a flush when another becomes current
    bool reportsResets = true;               // false after the driver has refused once
    std::vector<GLXFBConfig> configs;        // configurations for double-buffered pbuffers
    std::vector<ConfigCandidate> candidates; // same order
    int maxSurfaceSize = kMaxSurfaceSize;    // measured when the platform opens

    [[nodiscard]] bool has(const char* extension) const;
};

// Opens the display that DISPLAY names. Fills the state except maxSurfaceSize.
Result<void> openGlxDisplay(GlxDisplayState& state);

// Catches the X errors of one display during its lifetime. Xlib's own handler would end the process. Errors of other
// displays go to the previous handler. The handler is process-wide, so traps of other threads (pipes) wait.
class XErrorTrap {
public:
    explicit XErrorTrap(const GlxDisplayState& state);
    XErrorTrap(const XErrorTrap&) = delete;
    XErrorTrap& operator=(const XErrorTrap&) = delete;
    ~XErrorTrap();

    // Waits until the server has processed all requests. Returns an empty text if no error occurred since the trap was
    // set.
    std::string take();

private:
    static int handle(::Display* display, XErrorEvent* event);

    std::unique_lock<std::recursive_mutex> lock_;
    const GlxDisplayState& state_;
    XErrorTrap* outer_;
    XErrorHandler previous_;
    std::string text_;
};

} // namespace mural::gl
