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
    // Null where EGL_KHR_image_base is missing.
    PFNEGLCREATEIMAGEKHRPROC createImage = nullptr;
    PFNEGLDESTROYIMAGEKHRPROC destroyImage = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC getPlatformDisplay = nullptr;
    // Null where the extensions of devices are missing.
    PFNEGLQUERYDEVICESEXTPROC queryDevices = nullptr;
    PFNEGLQUERYDEVICESTRINGEXTPROC queryDeviceString = nullptr;
    PFNEGLQUERYDISPLAYATTRIBEXTPROC queryDisplayAttrib = nullptr;
};

// Surfaces and contexts that nobody needs any more, until the next ones are current: NVIDIA's driver (580.159) looks
// at what it knew of those before them then, and where they were released and destroyed meanwhile it ended the process (half
// of all nodes that started; seen in its memory: what it looked at was another one's by then). For the same reason nothing is
// released there before others become current.
class EglLeftOvers {
public:
    void addSurface(EGLSurface surface);
    void addContext(EGLContext context);
    // Others are current now, or nothing ever will be.
    void destroy(const EglFunctions& egl, EGLDisplay display);

private:
    std::mutex mutex_; // contexts of second threads go by those
    std::vector<EGLSurface> surfaces_;
    std::vector<EGLContext> contexts_;
};

// Never terminated: EGL hands out the same display to everyone who asks in this process, and another
// platform (the next pipe's) may still draw with it.
struct EglDisplayState {
    EglFunctions egl;
    EGLDisplay display = EGL_NO_DISPLAY;
    std::string where; // "surfaceless" or "device 0"
    bool software = false;
    bool mesa = false; // by its vendor
    std::string extensions;
    int version = 0; // 10 * major + minor
    bool noConfigContext = false;
    bool surfaceless = false;
    bool colorspace = false;
    bool flushControl = false; // contexts can be asked not to flush when another one becomes current; Mesa's alone are
    // Measured when the platform is opened.
    int maxSurfaceSize = kMaxSurfaceSize;
    ColorBuffers colorBuffers = ColorBuffers::OneNamedFront;
    bool tellsResets = true; // until a driver has refused
    EglLeftOvers left;

    EglDisplayState() = default;
    EglDisplayState(const EglDisplayState&) = delete;
    EglDisplayState& operator=(const EglDisplayState&) = delete;
    ~EglDisplayState() { left.destroy(egl, display); }

    [[nodiscard]] bool has(const char* extension) const;
};

// The surfaceless display, or one of a device. A GPU is preferred to a software renderer: with
// several vendors installed the surfaceless platform may lead to Mesa's software renderer although the
// machine's windows are drawn by another vendor's GPU. Of other drivers than Mesa a device's display is preferred, which
// all of them have had for long.
Result<std::shared_ptr<EglDisplayState>> openEglDisplay();

// That of a device, where `display` is the surfaceless one; else null. For drivers whose surfaceless display can't do
// what is needed.
std::shared_ptr<EglDisplayState> openOtherEglDisplay(const EglDisplayState& display);

struct EglConfigs {
    std::vector<EGLConfig> handles;
    std::vector<ConfigCandidate> candidates; // same order
};
// All that can make pbuffers. srgb: whether surfaces shall be made in the sRGB colour space, which
// with EGL belongs to the surface and not to its configuration.
EglConfigs listEglConfigs(const EglDisplayState& display, bool srgb);

// "EGL_BAD_MATCH (the wishes do not go together)"; takes the error of this thread.
std::string takeEglError(const EglFunctions& egl);

} // namespace mural::gl
