#include "nodes/gl/egl_display.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <utility>

namespace mural::gl {
namespace {

constexpr const char* kSurfaceless = "surfaceless"; // as EglDisplayState::where

bool hasWord(const char* words, const char* word) {
    const size_t length = std::strlen(word);
    for (const char* at = words; at && (at = std::strstr(at, word)); at += length)
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
    return false;
}

template <class Function> void loadExtension(const EglFunctions& egl, Function& function, const char* name) {
    function = reinterpret_cast<Function>(egl.getProcAddress(name));
}

} // namespace

Result<EglFunctions> loadEgl() {
    auto library = DynamicLibrary::open({"libEGL.so.1", "libEGL.so"}, "libegl1");
    if (!library) return library.error();
    EglFunctions egl;
    const bool complete =
        library->load(egl.bindApi, "eglBindAPI") && library->load(egl.createContext, "eglCreateContext") &&
        library->load(egl.createPbufferSurface, "eglCreatePbufferSurface") &&
        library->load(egl.destroyContext, "eglDestroyContext") &&
        library->load(egl.destroySurface, "eglDestroySurface") &&
        library->load(egl.getConfigAttrib, "eglGetConfigAttrib") && library->load(egl.getConfigs, "eglGetConfigs") &&
        library->load(egl.getCurrentContext, "eglGetCurrentContext") &&
        library->load(egl.getCurrentSurface, "eglGetCurrentSurface") && library->load(egl.getError, "eglGetError") &&
        library->load(egl.getProcAddress, "eglGetProcAddress") && library->load(egl.initialize, "eglInitialize") &&
        library->load(egl.makeCurrent, "eglMakeCurrent") && library->load(egl.queryString, "eglQueryString") &&
        library->load(egl.querySurface, "eglQuerySurface");
    if (!complete) return Error{library->name() + " lacks functions of EGL 1.4: install the package libegl1"};
    const char* client = egl.queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!hasWord(client, "EGL_EXT_platform_base"))
        return Error{library->name() + " lacks EGL_EXT_platform_base: install a driver with EGL 1.5"};
    loadExtension(egl, egl.getPlatformDisplay, "eglGetPlatformDisplayEXT");
    if (hasWord(client, "EGL_EXT_device_base") || hasWord(client, "EGL_EXT_device_enumeration"))
        loadExtension(egl, egl.queryDevices, "eglQueryDevicesEXT");
    if (hasWord(client, "EGL_EXT_device_base") || hasWord(client, "EGL_EXT_device_query")) {
        loadExtension(egl, egl.queryDeviceString, "eglQueryDeviceStringEXT");
        loadExtension(egl, egl.queryDisplayAttrib, "eglQueryDisplayAttribEXT");
    }
    return egl;
}

namespace {

bool isSoftware(const EglFunctions& egl, EGLDeviceEXT device) {
    const char* extensions = egl.queryDeviceString ? egl.queryDeviceString(device, EGL_EXTENSIONS) : nullptr;
    return hasWord(extensions, "EGL_MESA_device_software");
}

// Returns null, with the reason in `why`, if this display can't be initialized or lacks a necessary feature.
std::shared_ptr<EglDisplayState> initialize(const EglFunctions& egl, EGLDisplay display, std::string where,
                                            std::string& why) {
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY || !egl.initialize(display, &major, &minor)) {
        why += " " + where + ": " + takeEglError(egl) + ";";
        return nullptr;
    }
    auto state = std::make_shared<EglDisplayState>();
    state->egl = egl;
    state->display = display;
    state->where = std::move(where);
    state->version = 10 * major + minor;
    const char* extensions = egl.queryString(display, EGL_EXTENSIONS);
    state->extensions = extensions ? extensions : "";
    state->noConfigContext = state->has("EGL_KHR_no_config_context") || state->has("EGL_MESA_configless_context");
    state->surfaceless = state->has("EGL_KHR_surfaceless_context");
    const char* vendor = egl.queryString(display, EGL_VENDOR);
    state->mesa = vendor && std::strstr(vendor, "Mesa");
    state->flushControl = state->mesa && state->has("EGL_KHR_context_flush_control");
    state->colorspace = state->version >= 15 || state->has("EGL_KHR_gl_colorspace");
    if (state->has("EGL_KHR_image_base")) {
        loadExtension(egl, state->egl.createImage, "eglCreateImageKHR");
        loadExtension(egl, state->egl.destroyImage, "eglDestroyImageKHR");
    }
    if (state->version < 15 && !state->has("EGL_KHR_create_context")) {
        why += " " + state->where + ": no EGL_KHR_create_context;";
        return nullptr;
    }
    return state;
}

std::shared_ptr<EglDisplayState> openSurfaceless(const EglFunctions& egl, std::string& why) {
    if (!hasWord(egl.queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless")) {
        why += " surfaceless: no EGL_MESA_platform_surfaceless;";
        return nullptr;
    }
    EGLDisplay display =
        egl.getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr);
    auto state = initialize(egl, display, kSurfaceless, why);
    EGLAttrib device = 0;
    if (state && egl.queryDisplayAttrib && egl.queryDisplayAttrib(display, EGL_DEVICE_EXT, &device) && device)
        state->software = isSoftware(egl, reinterpret_cast<EGLDeviceEXT>(device));
    return state;
}

// Returns the display of a device that draws with a GPU. With `softwareToo`, a device with a software renderer is the
// second choice. Null: there is none.
std::shared_ptr<EglDisplayState> openDevice(const EglFunctions& egl, bool softwareToo, std::string& why) {
    EGLDeviceEXT devices[kMaxEglDevices];
    EGLint count = 0;
    if (!egl.queryDevices || !egl.queryDevices(kMaxEglDevices, devices, &count)) count = 0;
    if (count == 0) why += " devices: none;";
    for (const bool software : {false, true})
        for (EGLint i = 0; i < count && (softwareToo || !software); i++) {
            if (isSoftware(egl, devices[i]) != software) continue;
            EGLDisplay display = egl.getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
            auto state = initialize(egl, display, "device " + std::to_string(i), why);
            if (!state) continue;
            state->software = software;
            return state;
        }
    return nullptr;
}

// Returns the display of one of the GPUs in turn. Null: there are fewer than two.
std::shared_ptr<EglDisplayState> openDeviceInTurn(const EglFunctions& egl, int turn, std::string& why) {
    EGLDeviceEXT devices[kMaxEglDevices];
    EGLint count = 0;
    if (!egl.queryDevices || !egl.queryDevices(kMaxEglDevices, devices, &count)) count = 0;
    const auto gpus = std::count_if(devices, devices + count, [&](EGLDeviceEXT d) { return !isSoftware(egl, d); });
    if (gpus < 2) return nullptr;
    std::vector<std::shared_ptr<EglDisplayState>> open;
    for (EGLint i = 0; i < count; i++) {
        if (isSoftware(egl, devices[i])) continue;
        EGLDisplay display = egl.getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
        if (auto state = initialize(egl, display, "device " + std::to_string(i), why)) open.push_back(std::move(state));
        if (open.size() == static_cast<size_t>(turn) + 1) return open.back();
    }
    return open.empty() ? nullptr : open[static_cast<size_t>(turn) % open.size()];
}

// Returns the display of one of the GPUs that a job grants, in turn. Null: it names none of those that open.
std::shared_ptr<EglDisplayState> openGrantedDevice(const EglFunctions& egl, const std::string& names, int turn,
                                                   std::string& why) {
    const std::vector<EglDevice> list = listEglDevices();
    EGLDeviceEXT devices[kMaxEglDevices];
    EGLint count = 0;
    if (!egl.queryDevices || !egl.queryDevices(kMaxEglDevices, devices, &count)) count = 0;
    std::map<size_t, std::shared_ptr<EglDisplayState>> open;
    const std::vector<size_t> granted = selectGpus(names, list, [&](size_t number) {
        if (number >= static_cast<size_t>(count)) return false;
        EGLDisplay display = egl.getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[number], nullptr);
        return (open[number] = initialize(egl, display, "device " + std::to_string(number), why)) != nullptr;
    });
    return granted.empty() ? nullptr : open[granted[static_cast<size_t>(turn) % granted.size()]];
}

Result<std::shared_ptr<EglDisplayState>> openNamedDevice(const EglFunctions& egl, const std::string& name) {
    const std::vector<EglDevice> list = listEglDevices();
    size_t number = 0;
    while (number < list.size() && !matchesGpu(name, number, list[number])) ++number;
    EGLDeviceEXT devices[kMaxEglDevices];
    EGLint count = 0;
    if (number < list.size() && !egl.queryDevices(kMaxEglDevices, devices, &count)) count = 0;
    if (number >= static_cast<size_t>(count))
        return Error{"this machine has no GPU '" + name + "' (--gpus); its EGL devices: " + listOf(list)};
    std::string why;
    EGLDisplay display = egl.getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[number], nullptr);
    auto state = initialize(egl, display, "device " + std::to_string(number), why);
    if (!state) return Error{"the GPU '" + name + "' cannot be opened:" + why + " another one: --gpus"};
    state->software = list[number].software;
    return state;
}

} // namespace

void EglDeferredObjects::addSurface(EGLSurface surface) {
    const std::lock_guard lock(mutex_);
    surfaces_.push_back(surface);
}

void EglDeferredObjects::addContext(EGLContext context) {
    const std::lock_guard lock(mutex_);
    contexts_.push_back(context);
}

void EglDeferredObjects::destroy(const EglFunctions& egl, EGLDisplay display) {
    const std::lock_guard lock(mutex_);
    for (const EGLContext context : std::exchange(contexts_, {})) egl.destroyContext(display, context);
    for (const EGLSurface surface : std::exchange(surfaces_, {})) egl.destroySurface(display, surface);
}

bool EglDisplayState::has(const char* extension) const { return hasWord(extensions.c_str(), extension); }

Result<std::shared_ptr<EglDisplayState>> openEglDisplay(const GpuChoice& choice) {
    auto egl = loadEgl();
    if (!egl) return egl.error();
    if (!choice.name.empty()) return openNamedDevice(*egl, choice.name);
    std::string why;
    if (const std::string names = gpusOfJob([](const char* name) -> const char* { return std::getenv(name); });
        !names.empty())
        if (auto device = openGrantedDevice(*egl, names, choice.turn, why)) return device;
    if (choice.turns > 1)
        if (auto device = openDeviceInTurn(*egl, choice.turn, why)) return device;
    auto surfaceless = openSurfaceless(*egl, why);
    if (surfaceless && !surfaceless->software && surfaceless->mesa) return surfaceless;
    if (auto device = openDevice(*egl, !surfaceless, why)) return device;
    if (surfaceless) return surfaceless;
    return Error{"no EGL display without a window system opens (" + why.substr(why.empty() ? 0 : 1) +
                 "): install libegl-mesa0 or the GPU's driver"};
}

std::shared_ptr<EglDisplayState> openOtherEglDisplay(const EglDisplayState& display) {
    std::string why;
    return display.where == kSurfaceless ? openDevice(display.egl, true, why) : nullptr;
}

EglConfigs listEglConfigs(const EglDisplayState& display, bool srgb) {
    EglConfigs all;
    EGLint count = 0;
    if (!display.egl.getConfigs(display.display, nullptr, 0, &count) || count <= 0) return all;
    std::vector<EGLConfig> handles(static_cast<size_t>(count));
    display.egl.getConfigs(display.display, handles.data(), count, &count);
    for (EGLint i = 0; i < count; i++) {
        auto attribute = [&](EGLint name) {
            EGLint value = 0;
            return display.egl.getConfigAttrib(display.display, handles[static_cast<size_t>(i)], name, &value) ? value
                                                                                                               : 0;
        };
        if (!(attribute(EGL_SURFACE_TYPE) & EGL_PBUFFER_BIT)) continue;
        if (attribute(EGL_COLOR_BUFFER_TYPE) != EGL_RGB_BUFFER) continue;
        ConfigCandidate candidate;
        candidate.bits.red = attribute(EGL_RED_SIZE);
        candidate.bits.green = attribute(EGL_GREEN_SIZE);
        candidate.bits.blue = attribute(EGL_BLUE_SIZE);
        candidate.bits.alpha = attribute(EGL_ALPHA_SIZE);
        candidate.bits.depth = attribute(EGL_DEPTH_SIZE);
        candidate.bits.stencil = attribute(EGL_STENCIL_SIZE);
        candidate.bits.samples = attribute(EGL_SAMPLES);
        candidate.bits.srgb = srgb && display.colorspace;
        // EGL has neither accumulation buffers nor stereo pbuffers.
        const bool floats = display.has("EGL_EXT_pixel_format_float") &&
                            attribute(EGL_COLOR_COMPONENT_TYPE_EXT) == EGL_COLOR_COMPONENT_TYPE_FLOAT_EXT;
        const bool everyApi = (attribute(EGL_RENDERABLE_TYPE) & EGL_OPENGL_BIT) != 0;
        candidate.rank = (everyApi ? 0 : 4) + (floats ? 2 : 0) + (attribute(EGL_CONFIG_CAVEAT) != EGL_NONE ? 1 : 0);
        all.handles.push_back(handles[static_cast<size_t>(i)]);
        all.candidates.push_back(candidate);
    }
    return all;
}

std::string takeEglError(const EglFunctions& egl) {
    switch (const EGLint code = egl.getError(); code) {
    case EGL_SUCCESS: return "no EGL error";
    case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS (current in another thread)";
    case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC (not enough memory)";
    case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT: return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH: return "EGL_BAD_MATCH (the driver does not have it)";
    case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
    case EGL_BAD_SURFACE: return "EGL_BAD_SURFACE";
    case EGL_CONTEXT_LOST: return "EGL_CONTEXT_LOST";
    default: return "EGL error " + std::to_string(code);
    }
}

} // namespace mural::gl
