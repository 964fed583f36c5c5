// Grabs the X server while it draws, swaps and reads its windows through X, as rubber bands, window managers and
// screenshot tools do. It prints a checksum of the pixels read in each step, and the duration of the grab.
//
//   grabbed_server WAY
//
//   xlib, xcb, checked   the function that grabs: Xlib, XCB, or XCB with a checked request
//   nested               two grabs and one release; then it draws and grabs again
//   early                the grab precedes the first GL call
//   second               another connection of the process holds the grab and reads
//   closed               that connection is closed while it holds the grab
//   front                a single-buffered window, shown by glFlush
//   two                  two windows, drawn alternately
//   large                a window larger than the transfer buffers
//   opened               a window that is created and first shown during the grab
//   thread               another thread swaps during the grab
//   copy                 the window is copied into a pixmap, which is read
//   egl                  EGL instead of GLX
//   without              no grab; draws for 3 s
//   hold                 no drawing: simulates another program that holds a grab for 2 s
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"

#include <EGL/egl.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <string>
#include <thread>
#include <xcb/xcb.h>

using namespace programs;

namespace {

int width = 200, height = 150;

void scene(int frame) {
    glViewport(0, 0, width, height);
    glClearColor(0.1F * float(frame % 7), 0.3F, 0.05F * float(frame), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 20; ++i) {
        const float x = 0.09F * float((i * 5 + frame * 3) % 20) - 0.95F, y = 0.08F * float(i) - 0.9F;
        glColor3f(0.05F * float(i), 1 - 0.05F * float(i), 0.1F * float(frame % 9));
        glVertex2f(x, y);
        glVertex2f(x + 0.3F, y);
        glVertex2f(x + 0.1F, y + 0.4F);
    }
    glEnd();
}

// GLX or EGL, one context for all windows.
class Gl {
public:
    Gl(Display* display, bool byEgl, bool doubleBuffered) : display_(display), doubleBuffered_(doubleBuffered) {
        byEgl ? openEgl() : openGlx();
    }

    ::Window window(int x) {
        XSetWindowAttributes attributes{};
        attributes.colormap = XCreateColormap(display_, DefaultRootWindow(display_), visual_->visual, AllocNone);
        attributes.override_redirect = True;
        const ::Window made = XCreateWindow(display_, DefaultRootWindow(display_), x, 0, unsigned(width),
                                            unsigned(height), 0, visual_->depth, InputOutput, visual_->visual,
                                            CWColormap | CWBorderPixel | CWOverrideRedirect, &attributes);
        XMapWindow(display_, made);
        XSync(display_, False);
        return made;
    }
    void bind(::Window window) {
        if (egl_ == nullptr) {
            if (glXMakeCurrent(display_, window, glx_) == False) fail("glXMakeCurrent");
            return;
        }
        if (surface_ == nullptr) surface_ = eglCreateWindowSurface(egl_, config_, window, nullptr);
        if (eglMakeCurrent(egl_, surface_, surface_, eglContext_) == EGL_FALSE) fail("eglMakeCurrent");
    }
    void swap(::Window window) {
        if (!doubleBuffered_)
            glFlush();
        else if (egl_ == nullptr)
            glXSwapBuffers(display_, window);
        else
            eglSwapBuffers(egl_, surface_);
    }
    void release() { glXMakeCurrent(display_, None, nullptr); }

private:
    void openGlx() {
        int attributes[] = {GLX_RGBA, GLX_RED_SIZE,  8, GLX_GREEN_SIZE,
                            8,        GLX_BLUE_SIZE, 8, doubleBuffered_ ? int(GLX_DOUBLEBUFFER) : int(None),
                            None};
        visual_ = glXChooseVisual(display_, DefaultScreen(display_), attributes);
        if (visual_ == nullptr) fail("no visual");
        glx_ = glXCreateContext(display_, visual_, nullptr, True);
    }
    void openEgl() {
        egl_ = eglGetDisplay(display_);
        eglInitialize(egl_, nullptr, nullptr);
        eglBindAPI(EGL_OPENGL_API);
        const EGLint wanted[] = {EGL_RED_SIZE,   8,       EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                 EGL_WINDOW_BIT, EGL_NONE};
        EGLint count = 0, id = 0;
        if (eglChooseConfig(egl_, wanted, &config_, 1, &count) == EGL_FALSE || count == 0) fail("no configuration");
        eglGetConfigAttrib(egl_, config_, EGL_NATIVE_VISUAL_ID, &id);
        XVisualInfo like{};
        like.visualid = static_cast<VisualID>(id);
        visual_ = XGetVisualInfo(display_, VisualIDMask, &like, &count);
        eglContext_ = eglCreateContext(egl_, config_, EGL_NO_CONTEXT, nullptr);
        if (visual_ == nullptr || eglContext_ == EGL_NO_CONTEXT) fail("no context");
    }

    Display* display_;
    bool doubleBuffered_;
    XVisualInfo* visual_ = nullptr;
    GLXContext glx_ = nullptr;
    EGLDisplay egl_ = nullptr;
    EGLConfig config_ = nullptr;
    EGLContext eglContext_ = nullptr;
    EGLSurface surface_ = nullptr;
};

void printSum(const char* where, Display* display, Drawable drawable) {
    XImage* const image = XGetImage(display, drawable, 0, 0, unsigned(width), unsigned(height), AllPlanes, ZPixmap);
    if (image == nullptr) fail("XGetImage");
    std::uint32_t hash = 2166136261U;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            hash = (hash ^ static_cast<std::uint32_t>(XGetPixel(image, x, y) & 0xffffff)) * 16777619U;
    XDestroyImage(image);
    std::printf("%s %08x\n", where, hash);
}

// As in X11/Xlib-xcb.h, whose package is not needed for this one declaration.
xcb_connection_t* xcbOf(Display* display) {
    static auto* const get = reinterpret_cast<xcb_connection_t* (*)(Display*)>(
        dlsym(dlopen("libX11-xcb.so.1", RTLD_NOW), "XGetXCBConnection"));
    return get(display);
}

void grab(Display* display, const std::string& way) {
    if (way == "xcb" || way == "egl")
        xcb_grab_server(xcbOf(display));
    else if (way == "checked")
        std::free(xcb_request_check(xcbOf(display), xcb_grab_server_checked(xcbOf(display))));
    else
        XGrabServer(display);
    if (way == "nested") XGrabServer(display);
    XSync(display, False);
}

void ungrab(Display* display, const std::string& way) {
    if (way == "xcb" || way == "egl")
        xcb_ungrab_server(xcbOf(display));
    else if (way == "checked")
        std::free(xcb_request_check(xcbOf(display), xcb_ungrab_server_checked(xcbOf(display))));
    else
        XUngrabServer(display);
    // Not flushed: the next swap does not wait for a release that the server has not seen.
}

void drawInThread(Gl& gl, ::Window window) {
    gl.release();
    std::thread([&] {
        gl.bind(window);
        for (int frame = 10; frame < 13; ++frame) {
            scene(frame);
            gl.swap(window);
        }
        gl.release();
    }).join();
    gl.bind(window);
}

void drawDuringGrab(Gl& gl, const std::string& way, ::Window first, ::Window other, Display* eyes) {
    for (int frame = 3; frame < 7; ++frame) {
        const ::Window window = way == "two" && frame % 2 == 0 ? other : first;
        if (way == "two" || way == "opened") gl.bind(window);
        scene(frame);
        gl.swap(window);
        if (way == "two") printSum("during, in turn", eyes, window);
    }
    printSum("during", eyes, first);
    if (way == "two") printSum("during, the other", eyes, other);
    if (way == "thread") {
        drawInThread(gl, first);
        printSum("during, by a thread", eyes, first);
    }
    if (way == "copy") {
        const Pixmap pixmap = XCreatePixmap(eyes, first, unsigned(width), unsigned(height),
                                            unsigned(DefaultDepth(eyes, DefaultScreen(eyes))));
        const GC gc = XCreateGC(eyes, pixmap, 0, nullptr);
        scene(8);
        gl.swap(first);
        XCopyArea(eyes, first, pixmap, gc, 0, 0, unsigned(width), unsigned(height), 0, 0);
        printSum("during, copied", eyes, pixmap);
    }
}

void drawForAWhile(Gl& gl, ::Window window, Display* eyes) {
    for (int frame = 0; frame < 60; ++frame) {
        scene(frame);
        gl.swap(window);
        if (frame % 6 == 0) printSum("without a grab", eyes, window);
        std::fflush(stdout);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
}

void hold(Display* display) {
    XGrabServer(display);
    XSync(display, False);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    XUngrabServer(display);
    XSync(display, False);
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) fail("usage: grabbed_server WAY");
    const std::string way = argv[1];
    if (way == "large") width = 1600, height = 1000;
    Display* const display = XOpenDisplay(nullptr);
    Display* const holder = way == "second" || way == "closed" ? XOpenDisplay(nullptr) : display;
    if (display == nullptr || holder == nullptr) fail("no display");
    if (way == "hold") {
        hold(display);
        return 0;
    }
    const auto began = std::chrono::steady_clock::now();
    if (way == "early") grab(display, way);
    Gl gl(display, way == "egl", way != "front");
    ::Window first = gl.window(0);
    const ::Window other = way == "two" ? gl.window(width) : first;
    gl.bind(first);
    for (int frame = 1; frame < 3; ++frame) {
        scene(frame);
        gl.swap(first);
    }
    if (way == "without") {
        drawForAWhile(gl, first, display);
        return 0;
    }
    grab(holder, way);
    if (way == "opened") first = gl.window(width);
    drawDuringGrab(gl, way, first, other, holder);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    if (way == "closed")
        XCloseDisplay(holder);
    else
        ungrab(holder, way);
    gl.bind(first);
    scene(20);
    gl.swap(first);
    printSum("after", display, first);
    if (way == "nested") {
        grab(holder, way);
        drawDuringGrab(gl, way, first, other, holder);
        ungrab(holder, way);
        printSum("at the end", display, first);
    }
    std::fprintf(stderr, "grabbed for %.2f s\n", seconds);
    return 0;
}
