#define EGL_EGLEXT_PROTOTYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

namespace programs {
namespace {

EGLDisplay initializeEgl() {
    static const EGLDisplay display = [] {
        EGLDisplay opened = eglGetDisplay(openDisplayOnce());
        if (opened == EGL_NO_DISPLAY || eglInitialize(opened, nullptr, nullptr) != EGL_TRUE) {
            fail("no EGL on this X display (EGL error 0x%04x)", eglGetError());
        }
        return opened;
    }();
    return display;
}

int renderableBit(const WindowSpec& spec) {
    if (spec.profile != Profile::Es) {
        return EGL_OPENGL_BIT;
    }
    if (spec.major == 1) {
        return EGL_OPENGL_ES_BIT;
    }
    return spec.major >= 3 ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_ES2_BIT;
}

EGLConfig chooseConfig(EGLDisplay display, const WindowSpec& spec) {
    const EGLint attributes[] = {EGL_SURFACE_TYPE,
                                 EGL_WINDOW_BIT,
                                 EGL_RENDERABLE_TYPE,
                                 renderableBit(spec),
                                 EGL_RED_SIZE,
                                 8,
                                 EGL_GREEN_SIZE,
                                 8,
                                 EGL_BLUE_SIZE,
                                 8,
                                 EGL_ALPHA_SIZE,
                                 spec.alpha,
                                 EGL_DEPTH_SIZE,
                                 spec.depth,
                                 EGL_STENCIL_SIZE,
                                 spec.stencil,
                                 EGL_SAMPLES,
                                 spec.samples,
                                 EGL_NONE};
    EGLConfig configs[128];
    EGLint count = 0;
    if (eglChooseConfig(display, attributes, configs, 128, &count) != EGL_TRUE || count == 0) {
        fail("no EGL configuration fits; see eglinfo");
    }
    // EGL sorts deeper alpha first: choose exactly the requested alpha.
    for (int i = 0; i < count; ++i) {
        EGLint alpha = 0;
        eglGetConfigAttrib(display, configs[i], EGL_ALPHA_SIZE, &alpha);
        if (alpha == spec.alpha) {
            return configs[i];
        }
    }
    return configs[0];
}

XVisualInfo visualOf(EGLDisplay display, EGLConfig config) {
    EGLint id = 0;
    eglGetConfigAttrib(display, config, EGL_NATIVE_VISUAL_ID, &id);
    XVisualInfo wanted = {};
    wanted.visualid = static_cast<VisualID>(id);
    int count = 0;
    XVisualInfo* found = XGetVisualInfo(openDisplayOnce(), VisualIDMask, &wanted, &count);
    if (found == nullptr || count == 0) {
        fail("the EGL configuration has no visual");
    }
    const XVisualInfo visual = found[0];
    XFree(found);
    return visual;
}

class EglWindow : public Window {
public:
    EglWindow(const WindowSpec& spec, int width, int height, const EglWindow* share)
        : Window(width, height), display_(initializeEgl()), es_(spec.profile == Profile::Es) {
        bindApi();
        const EGLConfig config = chooseConfig(display_, spec);
        window_ = std::make_unique<XWindow>(visualOf(display_, config), spec.x, spec.y, width, height);
        surface_ = eglCreateWindowSurface(display_, config, window_->id(), nullptr);
        if (surface_ == EGL_NO_SURFACE) {
            fail("no EGL window surface (EGL error 0x%04x)", eglGetError());
        }
        context_ = createContext(config, spec, share != nullptr ? share->context_ : EGL_NO_CONTEXT);
        if (context_ == EGL_NO_CONTEXT) {
            fail("no EGL context of version %d.%d (EGL error 0x%04x)", spec.major, spec.minor, eglGetError());
        }
    }

    ~EglWindow() override {
        if (eglGetCurrentContext() == context_) {
            release();
        }
        eglDestroyContext(display_, context_);
        eglDestroySurface(display_, surface_);
    }

    void makeCurrent() override {
        bindApi();
        if (eglMakeCurrent(display_, surface_, surface_, context_) != EGL_TRUE) {
            fail("eglMakeCurrent failed (EGL error 0x%04x)", eglGetError());
        }
    }

    void makeCurrentReading(Window& from) override {
        bindApi();
        const auto& other = static_cast<EglWindow&>(from);
        if (eglMakeCurrent(display_, surface_, other.surface_, context_) != EGL_TRUE) {
            fail("eglMakeCurrent with two windows failed (EGL error 0x%04x)", eglGetError());
        }
    }

    void release() override {
        bindApi();
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

    void swap() override {
        if (eglSwapBuffers(display_, surface_) != EGL_TRUE) {
            fail("eglSwapBuffers failed (EGL error 0x%04x)", eglGetError());
        }
    }

    void resize(int width, int height) override {
        window_->resize(width, height);
        width_ = width;
        height_ = height;
    }

private:
    void bindApi() const { eglBindAPI(es_ ? EGL_OPENGL_ES_API : EGL_OPENGL_API); }

    EGLContext createContext(EGLConfig config, const WindowSpec& spec, EGLContext share) const {
        if (spec.major == 0) {
            const EGLint none = EGL_NONE;
            return eglCreateContext(display_, config, share, &none);
        }
        EGLint attributes[] = {
            EGL_CONTEXT_MAJOR_VERSION, spec.major, EGL_CONTEXT_MINOR_VERSION, spec.minor, EGL_NONE, 0, EGL_NONE};
        if (spec.profile == Profile::Core) {
            attributes[4] = EGL_CONTEXT_OPENGL_PROFILE_MASK;
            attributes[5] = EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT;
        }
        return eglCreateContext(display_, config, share, attributes);
    }

    EGLDisplay display_;
    bool es_;
    std::unique_ptr<XWindow> window_;
    EGLSurface surface_ = EGL_NO_SURFACE;
    EGLContext context_ = EGL_NO_CONTEXT;
};

} // namespace

std::unique_ptr<Window> openEglWindow(const WindowSpec& spec, int width, int height, Window* share) {
    return std::make_unique<EglWindow>(spec, width, height, static_cast<EglWindow*>(share));
}

} // namespace programs
