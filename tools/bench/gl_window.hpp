// A small double-buffered window with a compatibility context, and a GLSL program of one colour.
#pragma once

#include <GL/glx.h>
#include <X11/Xlib.h>

#include <memory>

namespace mural::bench {

// Use on the opening thread only; the context stays current.
class GlWindow {
public:
    // Returns null, with one line on standard error, without a display or GLX.
    static std::unique_ptr<GlWindow> open(int width, int height);
    GlWindow(const GlWindow&) = delete;
    GlWindow& operator=(const GlWindow&) = delete;
    ~GlWindow();

    void show() { glXSwapBuffers(display_, window_); }

    template <class Function> Function function(const char* name) const {
        return reinterpret_cast<Function>(glXGetProcAddressARB(reinterpret_cast<const GLubyte*>(name)));
    }

    // Creates a program that fills with the uniform at `location`. Returns 0, with one line on standard error, if
    // linking fails.
    GLuint colourProgram(GLint& location) const;

private:
    GlWindow() = default;
    bool makeWindow(int width, int height);

    Display* display_ = nullptr;
    Window window_ = 0;
    Colormap colours_ = 0;
    GLXContext context_ = nullptr;
};

} // namespace mural::bench
