// Opens a window with GLX functions found by name, for programs that do not link them.
#pragma once

#include <GL/glx.h>

#include "tests/programs/routes/scene.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

namespace programs {

// Runs the scene in a window. `findGlx` finds glX names and `findGl` finds gl names. `atEnd` may inspect the window
// after the last frame.
inline int runSceneByGlx(const Options& options, FindFunction findGlx, FindFunction findGl,
                         void (*atEnd)(Display*, ::Window, int width) = nullptr) {
    const auto chooseVisual = reinterpret_cast<decltype(&::glXChooseVisual)>(findGlx("glXChooseVisual"));
    const auto createContext = reinterpret_cast<decltype(&::glXCreateContext)>(findGlx("glXCreateContext"));
    const auto makeCurrent = reinterpret_cast<decltype(&::glXMakeCurrent)>(findGlx("glXMakeCurrent"));
    const auto swapBuffers = reinterpret_cast<decltype(&::glXSwapBuffers)>(findGlx("glXSwapBuffers"));
    const auto destroyContext = reinterpret_cast<decltype(&::glXDestroyContext)>(findGlx("glXDestroyContext"));
    if (chooseVisual == nullptr || createContext == nullptr || makeCurrent == nullptr || swapBuffers == nullptr) {
        fail("GLX functions are missing");
    }
    Display* display = openDisplayOnce();
    int attributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, GLX_DEPTH_SIZE, 24, None};
    XVisualInfo* visual = chooseVisual(display, DefaultScreen(display), attributes);
    if (visual == nullptr) {
        fail("no GLX visual");
    }
    const XWindow window(*visual, 0, 0, options.width, options.height);
    const GLXContext context = createContext(display, visual, nullptr, True);
    makeCurrent(display, window.id(), context);
    Scene scene(findGl);
    for (int frame = 0; frame < options.frames; ++frame) {
        scene.draw(frame, options.width, options.height);
        swapBuffers(display, window.id());
    }
    if (atEnd != nullptr) {
        atEnd(display, window.id(), options.width);
    }
    makeCurrent(display, None, nullptr);
    destroyContext(display, context);
    XFree(visual);
    return 0;
}

} // namespace programs
