// A large window ends without a request that names it, then a small one shows equally many frames.
//
// WINDOWS_END in the environment selects the way:
//   parent      its parent is destroyed.
//   subwindows  all children of its parent are destroyed.
//   kill        the connection that created it is killed.
//   close       the connection that created it is closed.
//   shared      it stays, and another connection draws in it, too.
#include <GL/glx.h>
#include <cstdlib>
#include <string>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

Display* openDisplay() {
    Display* display = XOpenDisplay(nullptr);
    if (!display) fail("no X display");
    return display;
}

XVisualInfo* visualOf(Display* display) {
    int wanted[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, GLX_DEPTH_SIZE, 16, None};
    XVisualInfo* visual = glXChooseVisual(display, DefaultScreen(display), wanted);
    if (!visual) fail("no visual for OpenGL");
    return visual;
}

::Window makeWindow(Display* display, ::Window parent, int width, int height) {
    const XVisualInfo* visual = visualOf(display);
    XSetWindowAttributes attributes = {};
    attributes.colormap = XCreateColormap(display, DefaultRootWindow(display), visual->visual, AllocNone);
    const ::Window made =
        XCreateWindow(display, parent, 0, 0, static_cast<unsigned>(width), static_cast<unsigned>(height), 0,
                      visual->depth, InputOutput, visual->visual, CWColormap | CWBorderPixel, &attributes);
    XMapWindow(display, made);
    XSync(display, False);
    return made;
}

void showFrames(Display* display, ::Window window, GLXContext context, int frames, int which) {
    glXMakeCurrent(display, window, context);
    for (int frame = 0; frame < frames; ++frame) {
        glClearColor(0.25F * float(which), 0.1F * float(frame), 0.5F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        showBits(1, std::uint32_t(frame));
        glXSwapBuffers(display, window);
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const char* chosen = std::getenv("WINDOWS_END");
    const std::string way = chosen ? chosen : "parent";
    Display* display = openDisplay();
    Display* maker = way == "parent" || way == "subwindows" ? display : openDisplay();
    const ::Window parent = makeWindow(maker, DefaultRootWindow(maker), options.width, options.height);
    const ::Window large = makeWindow(maker, parent, options.width, options.height);
    const ::Window small = makeWindow(display, DefaultRootWindow(display), options.width / 2, options.height / 2);
    GLXContext context = glXCreateContext(display, visualOf(display), nullptr, True);
    showFrames(display, large, context, options.frames, 1);
    if (way == "shared") {
        showFrames(maker, large, glXCreateContext(maker, visualOf(maker), nullptr, True), options.frames, 3);
        return 0;
    }
    if (way == "parent")
        XDestroyWindow(display, parent);
    else if (way == "subwindows")
        XDestroySubwindows(display, parent);
    else if (way == "kill")
        XKillClient(display, large);
    else
        XCloseDisplay(maker);
    XSync(display, False);
    showFrames(display, small, context, options.frames, 2);
    return 0;
}
