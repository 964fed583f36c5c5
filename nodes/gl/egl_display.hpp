// An EGL display without a window system, and the functions of libEGL.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#define EGL_NO_X11 // eglplatform.h must not pull in Xlib and its macros
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "nodes/gl/config_match.hpp"
#include "nodes/gl/dynamic_library.hpp"
#include "nodes/gl/gpu_choice.hpp"

namespace mural::gl {

struct EglFunctions {
    decltype(&eglBindAPI) bindApi = nullptr;
    decltype(&eglCreateContext) createContext = nullptr;
    decltype(&eglCreatePbufferSurface) createPbufferSurface = nullptr;
    decltype(&eglDestroyContext) destroyContext = nullptr;
    decltype(&eglDestroySurface) destroySurface = nullptr;
    decltype(&eglGetConfigAttrib) getConfigAttrib = nullptr;
    decltype(&eglGetConfigs) getConfigs = nullptr;
    decltype(&eglGetCurrentContext) getCurrentContext = nullptr;
    decltype(&eglGetCurrentSurface) getCurrentSurface = nullptr;
    decltype(&eglGetError) getError = nullptr;
    decltype(&eglGetProcAddress) getProcAddress = nullptr;
    decltype(&eglInitialize) initialize = nullptr;
    decltype(&eglMakeCurrent) makeCurrent = nullptr;
    decltype(&eglQueryString) queryString = nullptr;
    decltype(&eglQuerySurface) querySurface = nullptr;
    // Null without EGL_KHR_image_base.
    PFNEGLCREATEIMAGEKHRPROC createImage = nullptr;
    PFNEGLDESTROYIMAGEKHRPROC destroyImage = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC getPlatformDisplay = nullptr;
    // Null without the device extensions.
    PFNEGLQUERYDEVICESEXTPROC queryDevices = nullptr;
    PFNEGLQUERYDEVICESTRINGEXTPROC queryDeviceString = nullptr;
    PFNEGLQUERYDISPLAYATTRIBEXTPROC queryDisplayAttrib = nullptr;
};

// Loads libEGL. Errors: it is missing, or lacks functions of EGL 1.4 or EGL_EXT_platform_base.
Result<EglFunctions> loadEgl();

// Keeps unused surfaces and contexts until others are current. NVIDIA's driver (580.159) accesses the previous surfaces
// and contexts in the next eglMakeCurrent. After their release and destruction, their memory held another object's
// data, and half of all starting nodes crashed. For the same reason Mural releases nothing on that driver before others
// are current.
class EglDeferredObjects {
public:
    void addSurface(EGLSurface surface);
    void addContext(EGLContext context);
    // Destroys all of them. Requires that other surfaces and contexts are current, or that none will be again.
    void destroy(const EglFunctions& egl, EGLDisplay display);

private:
    std::mutex mutex_; // other threads destroy the contexts of their shared readers
    std::vector<EGLSurface> surfaces_;
    std::vector<EGLContext> contexts_;
};

// The display is never terminated. EGL returns the same display to all callers in the process, so the platform of
// another pipe may still draw with it.
struct EglDisplayState {
    EglFunctions egl;
    EGLDisplay display = EGL_NO_DISPLAY;
    std::string where; // "surfaceless" or "device 0"
    bool software = false;
    bool mesa = false; // the vendor string names Mesa
    std::string extensions;
    int version = 0; // 10 * major + minor
    bool noConfigContext = false;
    bool surfaceless = false;
    bool colorspace = false;
    bool flushControl = false; // contexts can be created without a flush when another becomes current; Mesa only
    // Measured when the platform opens.
    int maxSurfaceSize = kMaxSurfaceSize;
    ColorBuffers colorBuffers = ColorBuffers::OneNamedFront;
    bool reportsResets = true; // false after the driver has refused once
    EglDeferredObjects deferredObjects;

    EglDisplayState() = default;
    EglDisplayState(const EglDisplayState&) = delete;
    EglDisplayState& operator=(const EglDisplayState&) = delete;
    ~EglDisplayState() { deferredObjects.destroy(egl, display); }

    [[nodiscard]] bool has(const char* extension) const;
};

// Opens the surfaceless display or the display of a device. A GPU is preferred to a software renderer. With several
// vendors installed, the surfaceless platform may select Mesa's software renderer although another vendor's GPU draws
// the machine's windows. With drivers other than Mesa a device's display is preferred; all of them have supported it
// for long. With several processes that divide the GPUs, each opens the display of a device. Devices that cannot be
// initialized, for instance because a job has no access to them, do not count.
Result<std::shared_ptr<EglDisplayState>> openEglDisplay(const GpuChoice& choice);

// Returns the display of a device if `display` is surfaceless, otherwise null. Some drivers lack a necessary feature on
// their surfaceless display.
std::shared_ptr<EglDisplayState> openOtherEglDisplay(const EglDisplayState& display);

struct EglConfigs {
    std::vector<EGLConfig> handles;
    std::vector<ConfigCandidate> candidates; // same order
};
// Lists all configurations for pbuffers. srgb: surfaces in the sRGB colour space, which in EGL is a property of the
// surface and not of its configuration.
EglConfigs listEglConfigs(const EglDisplayState& display, bool srgb);

// Returns and clears the error of this thread as text, such as "EGL_BAD_MATCH (the driver does not have it)".
std::string takeEglError(const EglFunctions& egl);

} // namespace mural::gl
