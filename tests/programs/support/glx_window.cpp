#include <GL/glx.h>
#include <GL/glxext.h>
#include <vector>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

namespace programs {
namespace {

GLXFBConfig chooseConfig(Display* display, const WindowSpec& spec) {
    const int attributes[] = {GLX_RENDER_TYPE,
                              GLX_RGBA_BIT,
                              GLX_DRAWABLE_TYPE,
                              GLX_WINDOW_BIT,
                              GLX_X_RENDERABLE,
                              True,
                              GLX_X_VISUAL_TYPE,
                              GLX_TRUE_COLOR,
                              GLX_RED_SIZE,
                              8,
                              GLX_GREEN_SIZE,
                              8,
                              GLX_BLUE_SIZE,
                              8,
                              GLX_ALPHA_SIZE,
                              spec.alpha,
                              GLX_DEPTH_SIZE,
                              spec.depth,
                              GLX_STENCIL_SIZE,
                              spec.stencil,
                              GLX_DOUBLEBUFFER,
                              spec.doubleBuffered ? True : False,
                              GLX_SAMPLE_BUFFERS,
                              spec.samples > 0 ? 1 : 0,
                              GLX_SAMPLES,
                              spec.samples,
                              GLX_ACCUM_RED_SIZE,
                              spec.accum,
                              GLX_ACCUM_GREEN_SIZE,
                              spec.accum,
                              GLX_ACCUM_BLUE_SIZE,
                              spec.accum,
                              GLX_ACCUM_ALPHA_SIZE,
                              spec.alpha > 0 ? spec.accum : 0,
                              None};
    int count = 0;
    GLXFBConfig* found = glXChooseFBConfig(display, DefaultScreen(display), attributes, &count);
    if (found == nullptr || count == 0) {
        fail("no GLX configuration fits; see glxinfo -v");
    }
    const GLXFBConfig config = found[0];
    XFree(found);
    return config;
}

GLXContext createContext(Display* display, GLXFBConfig config, const WindowSpec& spec, GLXContext share) {
    if (spec.major == 0) {
        return glXCreateNewContext(display, config, GLX_RGBA_TYPE, share, True);
    }
    const auto create = reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(
        glXGetProcAddress(reinterpret_cast<const GLubyte*>("glXCreateContextAttribsARB")));
    if (create == nullptr) {
        fail("no glXCreateContextAttribsARB");
    }
    int profile = GLX_CONTEXT_COMPATIBILITY_PROFILE_BIT_ARB;
    if (spec.profile == Profile::Core) {
        profile = GLX_CONTEXT_CORE_PROFILE_BIT_ARB;
    } else if (spec.profile == Profile::Es) {
        profile = GLX_CONTEXT_ES_PROFILE_BIT_EXT;
    }
    const int attributes[] = {GLX_CONTEXT_MAJOR_VERSION_ARB,
                              spec.major,
                              GLX_CONTEXT_MINOR_VERSION_ARB,
                              spec.minor,
                              GLX_CONTEXT_PROFILE_MASK_ARB,
                              profile,
                              None};
    return create(display, config, share, True, attributes);
}

class GlxWindow : public Window {
public:
    GlxWindow(const WindowSpec& spec, int width, int height, const GlxWindow* share)
        : Window(width, height), display_(openDisplayOnce()), config_(chooseConfig(display_, spec)) {
        XVisualInfo* visual = glXGetVisualFromFBConfig(display_, config_);
        if (visual == nullptr) {
            fail("the GLX configuration has no visual");
        }
        window_ = std::make_unique<XWindow>(*visual, spec.x, spec.y, width, height);
        XFree(visual);
        context_ = createContext(display_, config_, spec, share != nullptr ? share->context_ : nullptr);
        if (context_ == nullptr) {
            fail("no GLX context of version %d.%d", spec.major, spec.minor);
        }
    }

    ~GlxWindow() override {
        if (glXGetCurrentContext() == context_) {
            release();
        }
        glXDestroyContext(display_, context_);
    }

    void makeCurrent() override {
        if (glXMakeCurrent(display_, window_->id(), context_) != True) {
            fail("glXMakeCurrent failed");
        }
    }

    void makeCurrentReading(Window& from) override {
        const auto& other = static_cast<GlxWindow&>(from);
        if (glXMakeContextCurrent(display_, window_->id(), other.window_->id(), context_) != True) {
            fail("glXMakeContextCurrent with two windows failed");
        }
    }

    void release() override { glXMakeCurrent(display_, None, nullptr); }
    void swap() override { glXSwapBuffers(display_, window_->id()); }

    void resize(int width, int height) override {
        window_->resize(width, height);
        width_ = width;
        height_ = height;
    }

private:
    Display* display_;
    GLXFBConfig config_;
    std::unique_ptr<XWindow> window_;
    GLXContext context_ = nullptr;
};

} // namespace

std::unique_ptr<Window> openGlxWindow(const WindowSpec& spec, int width, int height, Window* share) {
    return std::make_unique<GlxWindow>(spec, width, height, static_cast<GlxWindow*>(share));
}

} // namespace programs
