#include "tests/gl/native_window.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace mural::test {
namespace {

// The X side, common to both.
class XWindow {
public:
    XWindow() : display_(XOpenDisplay(nullptr)) {}
    XWindow(const XWindow&) = delete;
    XWindow& operator=(const XWindow&) = delete;
    ~XWindow() {
        if (display_) XCloseDisplay(display_);
    }

    void create(const XVisualInfo& visual, int width, int height) {
        width_ = width;
        height_ = height;
        XSetWindowAttributes attributes{};
        const Window root = DefaultRootWindow(display_);
        attributes.colormap = XCreateColormap(display_, root, visual.visual, AllocNone);
        attributes.override_redirect = True;
        window_ = XCreateWindow(display_, root, 0, 0, static_cast<unsigned>(width), static_cast<unsigned>(height), 0,
                                visual.depth, InputOutput, visual.visual,
                                CWColormap | CWBorderPixel | CWOverrideRedirect, &attributes);
        XMapRaised(display_, window_);
        XSync(display_, False);
    }

    [[nodiscard]] std::vector<uint32_t> grab() const {
        XSync(display_, False);
        std::vector<uint32_t> pixels;
        XImage* image = XGetImage(display_, window_, 0, 0, static_cast<unsigned>(width_),
                                  static_cast<unsigned>(height_), AllPlanes, ZPixmap);
        for (int y = 0; image && y < height_; y++)
            for (int x = 0; x < width_; x++) pixels.push_back(static_cast<uint32_t>(XGetPixel(image, x, y)) & 0xffffff);
        if (image) XDestroyImage(image);
        return pixels;
    }

    [[nodiscard]] ::Display* display() const { return display_; }
    [[nodiscard]] Window window() const { return window_; }

private:
    ::Display* display_;
    Window window_ = 0;
    int width_ = 0, height_ = 0;
};

class GlxWindow final : public NativeWindow {
public:
    ~GlxWindow() override {
        if (!context_) return;
        glXMakeCurrent(x_.display(), 0, nullptr);
        glXDestroyContext(x_.display(), context_);
    }

    Result<void> open(const gl::ContextConfig& requested) {
        if (!x_.display()) return Error{"no X display"};
        GLXFBConfig config = choose(requested.surface);
        XVisualInfo* visual = config ? glXGetVisualFromFBConfig(x_.display(), config) : nullptr;
        if (!visual) return Error{"no GLX visual with these bits"};
        x_.create(*visual, requested.surface.width, requested.surface.height);
        XFree(visual);
        context_ = makeContext(config, requested);
        if (!context_ || !glXMakeCurrent(x_.display(), x_.window(), context_)) return Error{"no GLX context"};
        return {};
    }

    [[nodiscard]] FindProc find() const override {
        return [](const char* name) { return glXGetProcAddress(reinterpret_cast<const GLubyte*>(name)); };
    }
    std::vector<uint32_t> show() override {
        glXSwapBuffers(x_.display(), x_.window());
        return x_.grab();
    }

private:
    GLXFBConfig choose(const gl::SurfaceConfig& s) const {
        const int list[] = {GLX_X_RENDERABLE,
                            True,
                            GLX_DRAWABLE_TYPE,
                            GLX_WINDOW_BIT,
                            GLX_DOUBLEBUFFER,
                            True,
                            GLX_RED_SIZE,
                            s.red,
                            GLX_GREEN_SIZE,
                            s.green,
                            GLX_BLUE_SIZE,
                            s.blue,
                            GLX_ALPHA_SIZE,
                            s.alpha,
                            GLX_DEPTH_SIZE,
                            s.depth,
                            GLX_STENCIL_SIZE,
                            s.stencil,
                            GLX_ACCUM_RED_SIZE,
                            s.accum,
                            GLX_SAMPLES,
                            s.samples,
                            0};
        int count = 0;
        GLXFBConfig* all = glXChooseFBConfig(x_.display(), DefaultScreen(x_.display()), list, &count);
        GLXFBConfig chosen = nullptr;
        for (int i = 0; i < count && !chosen; i++) {
            auto is = [&](int name, int wanted) {
                int value = -1;
                return glXGetFBConfigAttrib(x_.display(), all[i], name, &value) == 0 && value == wanted;
            };
            if (is(GLX_RED_SIZE, s.red) && is(GLX_ALPHA_SIZE, s.alpha) && is(GLX_DEPTH_SIZE, s.depth) &&
                is(GLX_STENCIL_SIZE, s.stencil) && is(GLX_ACCUM_RED_SIZE, s.accum) && is(GLX_SAMPLES, s.samples) &&
                is(GLX_FRAMEBUFFER_SRGB_CAPABLE_ARB, s.srgb ? 1 : 0))
                chosen = all[i];
        }
        if (all) XFree(all);
        return chosen;
    }

    // With the old call for version 1, with the new one for others.
    GLXContext makeContext(GLXFBConfig config, const gl::ContextConfig& requested) const {
        if (requested.api == gl::Api::Desktop && requested.major == 1)
            return glXCreateNewContext(x_.display(), config, GLX_RGBA_TYPE, nullptr, True);
        auto create = reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(find()("glXCreateContextAttribsARB"));
        const int profile = requested.api != gl::Api::Desktop ? GLX_CONTEXT_ES_PROFILE_BIT_EXT
                            : requested.core                  ? GLX_CONTEXT_CORE_PROFILE_BIT_ARB
                                                              : GLX_CONTEXT_COMPATIBILITY_PROFILE_BIT_ARB;
        const int list[] = {GLX_CONTEXT_MAJOR_VERSION_ARB,
                            requested.major,
                            GLX_CONTEXT_MINOR_VERSION_ARB,
                            requested.minor,
                            GLX_CONTEXT_PROFILE_MASK_ARB,
                            profile,
                            0};
        return create(x_.display(), config, nullptr, True, list);
    }

    XWindow x_;
    GLXContext context_ = nullptr;
};

class EglWindow final : public NativeWindow {
public:
    ~EglWindow() override {
        if (egl_ == EGL_NO_DISPLAY) return;
        eglMakeCurrent(egl_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglTerminate(egl_);
    }

    Result<void> open(const gl::ContextConfig& requested) {
        if (!x_.display()) return Error{"no X display"};
        egl_ = eglGetPlatformDisplay(EGL_PLATFORM_X11_KHR, x_.display(), nullptr);
        if (!eglInitialize(egl_, nullptr, nullptr)) return Error{"no EGL on X"};
        EGLint visualId = 0;
        EGLConfig config = choose(requested.surface, visualId);
        XVisualInfo wanted{};
        wanted.visualid = static_cast<VisualID>(visualId);
        int count = 0;
        XVisualInfo* visual = config ? XGetVisualInfo(x_.display(), VisualIDMask, &wanted, &count) : nullptr;
        if (!visual) return Error{"no EGL configuration with these bits that has a visual"};
        x_.create(*visual, requested.surface.width, requested.surface.height);
        XFree(visual);
        surface_ = eglCreateWindowSurface(egl_, config, x_.window(), nullptr);
        const bool desktop = requested.api == gl::Api::Desktop;
        eglBindAPI(desktop ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
        const EGLint list[] = {EGL_CONTEXT_MAJOR_VERSION, requested.major, EGL_CONTEXT_MINOR_VERSION, requested.minor,
                               EGL_NONE};
        EGLContext context = eglCreateContext(egl_, config, EGL_NO_CONTEXT, list);
        if (!eglMakeCurrent(egl_, surface_, surface_, context)) return Error{"no EGL context for the window"};
        return {};
    }

    [[nodiscard]] FindProc find() const override { return eglGetProcAddress; }
    std::vector<uint32_t> show() override {
        eglSwapBuffers(egl_, surface_);
        return x_.grab();
    }

private:
    EGLConfig choose(const gl::SurfaceConfig& s, EGLint& visualId) const {
        const EGLint list[] = {EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_RED_SIZE,   s.red,     EGL_GREEN_SIZE, s.green,
                               EGL_BLUE_SIZE,    s.blue,         EGL_ALPHA_SIZE, s.alpha,   EGL_DEPTH_SIZE, s.depth,
                               EGL_STENCIL_SIZE, s.stencil,      EGL_SAMPLES,    s.samples, EGL_NONE};
        EGLConfig all[256];
        EGLint count = 0;
        eglChooseConfig(egl_, list, all, 256, &count);
        for (EGLint i = 0; i < count; i++) {
            auto value = [&](EGLint name) {
                EGLint got = -1;
                eglGetConfigAttrib(egl_, all[i], name, &got);
                return got;
            };
            visualId = value(EGL_NATIVE_VISUAL_ID);
            if (visualId && value(EGL_RED_SIZE) == s.red && value(EGL_ALPHA_SIZE) == s.alpha &&
                value(EGL_DEPTH_SIZE) == s.depth && value(EGL_STENCIL_SIZE) == s.stencil &&
                value(EGL_SAMPLES) == s.samples)
                return all[i];
        }
        return nullptr;
    }

    XWindow x_;
    EGLDisplay egl_ = EGL_NO_DISPLAY;
    EGLSurface surface_ = EGL_NO_SURFACE;
};

template <class Kind> Result<std::unique_ptr<NativeWindow>> open(const gl::ContextConfig& context) {
    auto window = std::make_unique<Kind>();
    if (auto opened = window->open(context); !opened) return opened.error();
    return std::unique_ptr<NativeWindow>(std::move(window));
}

} // namespace

Result<std::unique_ptr<NativeWindow>> openGlxWindow(const gl::ContextConfig& context) {
    return open<GlxWindow>(context);
}

Result<std::unique_ptr<NativeWindow>> openEglWindow(const gl::ContextConfig& context) {
    return open<EglWindow>(context);
}

} // namespace mural::test
