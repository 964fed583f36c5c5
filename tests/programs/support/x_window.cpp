#include "tests/programs/support/x_window.hpp"

#include <cerrno>

#include "tests/programs/support/program.hpp"

namespace programs {
namespace {

struct Wanted {
    ::Window window;
    int type;
    int width, height;
};

Bool isWanted(Display*, XEvent* event, XPointer argument) {
    const auto* wanted = reinterpret_cast<const Wanted*>(argument);
    if (event->type != wanted->type || event->xany.window != wanted->window) {
        return False;
    }
    if (wanted->type == ConfigureNotify) {
        const bool same = event->xconfigure.width == wanted->width && event->xconfigure.height == wanted->height;
        return same ? True : False;
    }
    return True;
}

void waitFor(Display* display, Wanted wanted) {
    XEvent event;
    XIfEvent(display, &event, isWanted, reinterpret_cast<XPointer>(&wanted));
}

} // namespace

Display* openDisplayOnce() {
    static Display* const display = [] {
        XInitThreads();
        Display* opened = XOpenDisplay(nullptr);
        if (opened == nullptr) {
            fail("no X display; set DISPLAY or run under xvfb-run");
        }
        return opened;
    }();
    return display;
}

::Window topmostWindow(Display* display) {
    ::Window root = 0, parent = 0, *children = nullptr;
    unsigned count = 0;
    if (XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count) == 0 || count == 0)
        fail("no window");
    const ::Window top = children[count - 1];
    XFree(children);
    return top;
}

XWindow::XWindow(const XVisualInfo& visual, int x, int y, int width, int height) : display_(openDisplayOnce()) {
    const ::Window root = RootWindow(display_, visual.screen);
    colormap_ = XCreateColormap(display_, root, visual.visual, AllocNone);
    XSetWindowAttributes attributes = {};
    attributes.colormap = colormap_;
    attributes.event_mask = StructureNotifyMask;
    id_ =
        XCreateWindow(display_, root, x, y, static_cast<unsigned>(width), static_cast<unsigned>(height), 0,
                      visual.depth, InputOutput, visual.visual, CWColormap | CWEventMask | CWBorderPixel, &attributes);
    XStoreName(display_, id_, program_invocation_short_name);
    XMapWindow(display_, id_);
    waitFor(display_, {id_, MapNotify, 0, 0});
}

XWindow::~XWindow() {
    XDestroyWindow(display_, id_);
    XFreeColormap(display_, colormap_);
    XSync(display_, False);
}

void XWindow::resize(int width, int height) {
    XWindowAttributes now{};
    XGetWindowAttributes(display_, id_, &now);
    if (now.width == width && now.height == height) return; // the server sends no event in this case
    XResizeWindow(display_, id_, static_cast<unsigned>(width), static_cast<unsigned>(height));
    waitFor(display_, {id_, ConfigureNotify, width, height});
}

} // namespace programs
