// A plain X window without decorations on the process's one display connection.
#pragma once

#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace programs {

Display* openDisplayOnce(); // thread-safe connection, opened on first use, never closed

// Returns the topmost window on the root. It is the program's own if the program has one window and no window manager
// runs. Ends the program if there is none.
::Window topmostWindow(Display* display);

class XWindow {
public:
    // Creates and maps the window, and waits until it is visible.
    XWindow(const XVisualInfo& visual, int x, int y, int width, int height);
    XWindow(const XWindow&) = delete;
    XWindow& operator=(const XWindow&) = delete;
    ~XWindow();

    [[nodiscard]] ::Window id() const { return id_; }
    void resize(int width, int height);

private:
    Display* display_;
    Colormap colormap_ = 0;
    ::Window id_ = 0;
};

} // namespace programs
