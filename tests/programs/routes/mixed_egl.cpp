// Two ways into one context (mixed.hpp), with a window through EGL.
#include <EGL/egl.h>

#include "tests/programs/routes/egl_scene.hpp"
#include "tests/programs/routes/mixed.hpp"
#include "tests/programs/support/x_window.hpp"

namespace {

programs::GlFunction find(const char* name) {
    return programs::isImmediate(name) ? programs::findElsewhere(name) : eglGetProcAddress(name);
}

// Returns the program's only window, the last one created on the display.
::Window ownWindow(Display* display) {
    ::Window root = 0, parent = 0, *children = nullptr;
    unsigned count = 0;
    XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count);
    const ::Window last = count > 0 ? children[count - 1] : root;
    XFree(children);
    return last;
}

} // namespace

int main(int argc, char** argv) {
    const programs::Options options = programs::parseOptions(argc, argv);
    return programs::runSceneByEgl(options, find, [&] {
        Display* display = programs::openDisplayOnce();
        programs::printWhetherComplete(display, ownWindow(display), options.width);
    });
}
