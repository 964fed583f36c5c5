#include "tools/mural/accuracy/scenes/scene_window.hpp"

#include <GL/glx.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace mural::scenes {

struct SceneWindow::Handles {
    Display* display = nullptr;
    Window window = 0;
    Colormap colours = 0;
    GLXContext context = nullptr;
};

SceneWindow::SceneWindow() : x_(std::make_unique<Handles>()) {}

std::unique_ptr<SceneWindow> SceneWindow::open(int width, int height, std::string& why) {
    std::unique_ptr<SceneWindow> opened(new SceneWindow);
    Handles& x = *opened->x_;
    x.display = XOpenDisplay(nullptr);
    if (x.display == nullptr) {
        why = "no X display; set DISPLAY, or use xvfb-run";
        return nullptr;
    }
    // 24 bits of depth and no stencil, as most programs request.
    int wanted[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8,   GLX_GREEN_SIZE, 8, GLX_BLUE_SIZE,
                    8,        GLX_DEPTH_SIZE,   24,           None};
    XVisualInfo* visual = glXChooseVisual(x.display, DefaultScreen(x.display), wanted);
    if (visual == nullptr) {
        why = "this display has no OpenGL (GLX) with a depth buffer; see mural doctor";
        return nullptr;
    }
    const Window root = RootWindow(x.display, visual->screen);
    x.colours = XCreateColormap(x.display, root, visual->visual, AllocNone);
    XSetWindowAttributes attributes{};
    attributes.colormap = x.colours;
    attributes.override_redirect = True; // prevents resizing by a window manager
    x.window = XCreateWindow(x.display, root, 0, 0, static_cast<unsigned>(width), static_cast<unsigned>(height), 0,
                             visual->depth, InputOutput, visual->visual,
                             CWColormap | CWOverrideRedirect | CWBorderPixel, &attributes);
    XStoreName(x.display, x.window, "mural-scenes");
    XMapWindow(x.display, x.window);
    XSync(x.display, False);
    x.context = glXCreateContext(x.display, visual, nullptr, True);
    XFree(visual);
    if (x.context == nullptr || glXMakeCurrent(x.display, x.window, x.context) != True) {
        why = "cannot create an OpenGL context; see mural doctor";
        return nullptr;
    }
    return opened;
}

void SceneWindow::show() { glXSwapBuffers(x_->display, x_->window); }

SceneWindow::~SceneWindow() {
    if (x_->display == nullptr) return;
    glXMakeCurrent(x_->display, None, nullptr);
    if (x_->context != nullptr) glXDestroyContext(x_->display, x_->context);
    if (x_->window != 0) XDestroyWindow(x_->display, x_->window);
    if (x_->colours != 0) XFreeColormap(x_->display, x_->colours);
    XCloseDisplay(x_->display);
}

} // namespace mural::scenes
