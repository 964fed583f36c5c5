// Prints each event of pointer and keyboard that its window receives: "button 1 down 80,100", "key 61 up" with the
// keysym in hex. Draws another colour after each event.
#include <cstdio>
#include <unistd.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

namespace {

int events = 0;

void printKey(XKeyEvent& event) {
    char text[16];
    KeySym keysym = 0;
    XLookupString(&event, text, sizeof text, &keysym, nullptr);
    std::printf("key %lx %s\n", keysym, event.type == KeyPress ? "down" : "up");
}

void printEvents(Display* display) {
    while (XPending(display) > 0) {
        XEvent event;
        XNextEvent(display, &event);
        if (event.type == MappingNotify) XRefreshKeyboardMapping(&event.xmapping);
        if (event.type == KeyPress || event.type == KeyRelease) printKey(event.xkey);
        if (event.type == ButtonPress || event.type == ButtonRelease)
            std::printf("button %u %s %d,%d\n", event.xbutton.button, event.type == ButtonPress ? "down" : "up",
                        event.xbutton.x, event.xbutton.y);
        if (event.type == MotionNotify) std::printf("move %d,%d\n", event.xmotion.x, event.xmotion.y);
        ++events;
    }
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
    return programs::runInGlxWindow(
        argc, argv, {},
        [](programs::Window&) {
            Display* display = programs::openDisplayOnce();
            const ::Window window = programs::topmostWindow(display);
            XSelectInput(display, window,
                         KeyPressMask | KeyReleaseMask | ButtonPressMask | ButtonReleaseMask | PointerMotionMask);
            XSetInputFocus(display, window, RevertToParent, CurrentTime);
            XSync(display, False);
        },
        [](programs::Window&, int frame) {
            printEvents(programs::openDisplayOnce());
            glClearColor(static_cast<float>(events % 8) / 8, 0.5F, 0.25F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            if (frame < 10) std::printf("frame %d\n", frame);
            std::fflush(stdout);
            usleep(5000);
        });
}
