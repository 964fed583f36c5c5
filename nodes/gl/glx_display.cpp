#include "nodes/gl/glx_display.hpp"

#include <cstdlib>
#include <cstring>
#include <utility>

namespace mural::gl {
namespace {

// Xlib's error handler is process-wide and has no user pointer.
XErrorTrap* innermostTrap = nullptr; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
std::recursive_mutex trapMutex;      // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

Result<void> loadFunctions(GlxFunctions& f) {
    auto x11 = DynamicLibrary::open({"libX11.so.6", "libX11.so"}, "libx11-6");
    if (!x11) return x11.error();
    auto glx = DynamicLibrary::open({"libGLX.so.0", "libGL.so.1"}, "libglx0 and libglx-mesa0");
    if (!glx) return glx.error();
    const bool xComplete = x11->load(f.openDisplay, "XOpenDisplay") && x11->load(f.closeDisplay, "XCloseDisplay") &&
                           x11->load(f.defaultScreen, "XDefaultScreen") && x11->load(f.free, "XFree") &&
                           x11->load(f.getErrorText, "XGetErrorText") &&
                           x11->load(f.setErrorHandler, "XSetErrorHandler") && x11->load(f.sync, "XSync");
    const bool glxComplete =
        glx->load(f.createPbuffer, "glXCreatePbuffer") && glx->load(f.destroyContext, "glXDestroyContext") &&
        glx->load(f.destroyPbuffer, "glXDestroyPbuffer") && glx->load(f.getFbConfigAttrib, "glXGetFBConfigAttrib") &&
        glx->load(f.getFbConfigs, "glXGetFBConfigs") && glx->load(f.getCurrentContext, "glXGetCurrentContext") &&
        glx->load(f.getCurrentDrawable, "glXGetCurrentDrawable") &&
        glx->load(f.getCurrentReadDrawable, "glXGetCurrentReadDrawable") &&
        glx->load(f.getProcAddress, "glXGetProcAddressARB") &&
        glx->load(f.makeContextCurrent, "glXMakeContextCurrent") && glx->load(f.queryDrawable, "glXQueryDrawable") &&
        glx->load(f.queryExtension, "glXQueryExtension") &&
        glx->load(f.queryExtensionsString, "glXQueryExtensionsString") && glx->load(f.queryVersion, "glXQueryVersion");
    if (xComplete && glxComplete) return {};
    return Error{(xComplete ? glx->name() : x11->name()) +
                 " lacks functions of GLX 1.3: install the packages libx11-6 and libglx0"};
}

// Lists only double-buffered configurations, as windows have them. GL_BACK does not exist with one buffer.
void listConfigs(GlxDisplayState& state) {
    int count = 0;
    GLXFBConfig* all = state.glx.getFbConfigs(state.display, state.screen, &count);
    const bool srgb = state.has("GLX_ARB_framebuffer_sRGB") || state.has("GLX_EXT_framebuffer_sRGB");
    for (int i = 0; i < count; i++) {
        auto attribute = [&](int name) {
            int value = 0;
            return state.glx.getFbConfigAttrib(state.display, all[i], name, &value) == 0 ? value : 0;
        };
        if (!(attribute(GLX_DRAWABLE_TYPE) & GLX_PBUFFER_BIT) || !attribute(GLX_DOUBLEBUFFER)) continue;
        const int renderType = attribute(GLX_RENDER_TYPE);
        if (!(renderType & (GLX_RGBA_BIT | GLX_RGBA_FLOAT_BIT_ARB))) continue;
        ConfigCandidate candidate;
        candidate.bits.red = attribute(GLX_RED_SIZE);
        candidate.bits.green = attribute(GLX_GREEN_SIZE);
        candidate.bits.blue = attribute(GLX_BLUE_SIZE);
        candidate.bits.alpha = attribute(GLX_ALPHA_SIZE);
        candidate.bits.depth = attribute(GLX_DEPTH_SIZE);
        candidate.bits.stencil = attribute(GLX_STENCIL_SIZE);
        candidate.bits.samples = attribute(GLX_SAMPLE_BUFFERS) ? attribute(GLX_SAMPLES) : 0;
        candidate.bits.accum = attribute(GLX_ACCUM_RED_SIZE);
        candidate.bits.srgb = srgb && attribute(GLX_FRAMEBUFFER_SRGB_CAPABLE_ARB) != 0;
        candidate.bits.stereo = attribute(GLX_STEREO) != 0;
        const bool window = (attribute(GLX_DRAWABLE_TYPE) & GLX_WINDOW_BIT) != 0;
        candidate.rank =
            (renderType & GLX_RGBA_BIT ? 0 : 4) + (window ? 0 : 2) + (attribute(GLX_CONFIG_CAVEAT) == GLX_NONE ? 0 : 1);
        state.configs.push_back(all[i]);
        state.candidates.push_back(candidate);
    }
    if (all) state.glx.free(all);
}

} // namespace

GlxDisplayState::~GlxDisplayState() {
    if (display) glx.closeDisplay(display);
}

bool GlxDisplayState::has(const char* extension) const {
    const char* words = glx.queryExtensionsString(display, screen);
    const size_t length = std::strlen(extension);
    for (const char* at = words; at && (at = std::strstr(at, extension)); at += length)
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
    return false;
}

Result<void> openGlxDisplay(GlxDisplayState& state) {
    if (auto loaded = loadFunctions(state.glx); !loaded) return loaded;
    const char* name = std::getenv("DISPLAY"); // NOLINT(concurrency-mt-unsafe): nodes never set it
    state.name = name ? name : "";
    state.display = state.glx.openDisplay(nullptr);
    if (!state.display)
        return Error{name ? "cannot open the X display '" + state.name + "': start the X server or use --gl egl"
                          : "DISPLAY is not set: GLX needs an X server; start one or use --gl egl"};
    state.screen = state.glx.defaultScreen(state.display);
    int major = 0, minor = 0;
    if (!state.glx.queryExtension(state.display, nullptr, nullptr) ||
        !state.glx.queryVersion(state.display, &major, &minor) || 10 * major + minor < 13)
        return Error{"the X display '" + state.name + "' has no GLX 1.3: start it with +extension GLX or use --gl egl"};
    state.glx.createContextAttribs = reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(
        state.glx.getProcAddress(reinterpret_cast<const GLubyte*>("glXCreateContextAttribsARB")));
    if (!state.glx.createContextAttribs || !state.has("GLX_ARB_create_context") ||
        !state.has("GLX_ARB_create_context_profile"))
        return Error{"GLX on '" + state.name + "' lacks GLX_ARB_create_context_profile: use --gl egl"};
    state.noConfigContext = state.has("GLX_EXT_no_config_context");
    state.esProfile = state.has("GLX_EXT_create_context_es_profile");
    state.robust = state.has("GLX_ARB_create_context_robustness");
    state.flushControl = state.has("GLX_ARB_context_flush_control");
    listConfigs(state);
    return {};
}

XErrorTrap::XErrorTrap(const GlxDisplayState& state)
    : lock_(trapMutex), state_(state), outer_(innermostTrap), previous_(nullptr) {
    state_.glx.sync(state_.display, 0); // errors of earlier requests do not count
    innermostTrap = this;
    previous_ = state_.glx.setErrorHandler(&XErrorTrap::handle);
}

XErrorTrap::~XErrorTrap() {
    state_.glx.sync(state_.display, 0);
    state_.glx.setErrorHandler(previous_);
    innermostTrap = outer_;
}

std::string XErrorTrap::take() {
    state_.glx.sync(state_.display, 0);
    return std::exchange(text_, {});
}

int XErrorTrap::handle(::Display* display, XErrorEvent* event) {
    XErrorTrap* trap = innermostTrap;
    if (!trap) return 0;
    if (display != trap->state_.display) return trap->previous_ ? trap->previous_(display, event) : 0;
    char message[128] = "";
    trap->state_.glx.getErrorText(display, event->error_code, message, sizeof message);
    if (trap->text_.empty()) trap->text_ = std::string("X error ") + message;
    return 0;
}

} // namespace mural::gl
