// Draws a moving picture, and shows a dialog: a plain X window of one colour, outside of OpenGL. Prints the presses of
// buttons that the dialog receives: "dialog button 1 down 20,10".
#include <cstdio>
#include <unistd.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

namespace {

constexpr int kLeft = 150, kTop = 100, kWidth = 120, kHeight = 60; // of the dialog, on the root
constexpr unsigned long kColour = 0x3366cc;                        // red, green, blue

void openDialog() {
    Display* display = programs::openDisplayOnce();
    XSetWindowAttributes attributes{};
    attributes.override_redirect = True; // as menus and popups
    attributes.background_pixel = kColour;
    attributes.event_mask = ButtonPressMask;
    const ::Window dialog =
        XCreateWindow(display, DefaultRootWindow(display), kLeft, kTop, kWidth, kHeight, 0, CopyFromParent, InputOutput,
                      CopyFromParent, CWOverrideRedirect | CWBackPixel | CWEventMask, &attributes);
    XMapRaised(display, dialog);
    XSync(display, False);
}

void printPresses(Display* display) {
    XEvent event;
    while (XCheckTypedEvent(display, ButtonPress, &event) == True)
        std::printf("dialog button %u down %d,%d\n", event.xbutton.button, event.xbutton.x, event.xbutton.y);
}

} // namespace

int main(int argc, char** argv) {
    return programs::runInGlxWindow(
        argc, argv, {}, [](programs::Window&) { openDialog(); },
        [](programs::Window&, int frame) {
            printPresses(programs::openDisplayOnce());
            glClearColor(static_cast<float>(frame % 64) / 64, 0.5F, 0.25F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            if (frame < 10) std::printf("frame %d\n", frame);
            std::fflush(stdout);
            usleep(20000);
        });
}
