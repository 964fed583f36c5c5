// A window that shows pictures without GL, drawn by X11 itself.
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

int main(int argc, char** argv) {
    const programs::Options options = programs::parseOptions(argc, argv);
    Display* display = programs::openDisplayOnce();
    XVisualInfo visual{};
    visual.screen = DefaultScreen(display);
    visual.visual = DefaultVisual(display, visual.screen);
    visual.depth = DefaultDepth(display, visual.screen);
    const programs::XWindow window(visual, 0, 0, options.width, options.height);
    for (int frame = 0; frame < options.frames; ++frame) {
        XFillRectangle(display, window.id(), DefaultGC(display, visual.screen), frame * 10, 10, 20, 20);
        XSync(display, False);
    }
    return 0;
}
