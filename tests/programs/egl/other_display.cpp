// Draws in a window on the display OTHER_DISPLAY. A window of DISPLAY has the same number and belongs to another
// program, so it must not change. Prints checksums of both windows.
//
//   other_display glx|both|egl|xcb|default
//   both: also in a window of DISPLAY; xcb: EGL has a connection of its own; default: EGL_DEFAULT_DISPLAY, DISPLAY
//   changed
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glx.h>
#include <X11/Xutil.h>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <xcb/xcb.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kWidth = 120, kHeight = 90;
constexpr int kMaxTries = 64;

Display* openDisplay(const char* variable) {
    const char* name = std::getenv(variable);
    Display* display = name ? XOpenDisplay(name) : nullptr;
    if (!display) fail("%s names no X display", variable);
    return display;
}

XVisualInfo* visualOf(Display* display) {
    int attributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, GLX_DEPTH_SIZE, 24, None};
    XVisualInfo* visual = glXChooseVisual(display, DefaultScreen(display), attributes);
    if (!visual) fail("no visual for OpenGL");
    return visual;
}

::Window makeWindow(Display* display, const XVisualInfo& visual, unsigned long background) {
    const ::Window root = DefaultRootWindow(display);
    XSetWindowAttributes attributes = {};
    attributes.background_pixel = background;
    attributes.colormap = XCreateColormap(display, root, visual.visual, AllocNone);
    const ::Window window = XCreateWindow(display, root, 0, 0, kWidth, kHeight, 0, visual.depth, InputOutput,
                                          visual.visual, CWBackPixel | CWColormap | CWBorderPixel, &attributes);
    XMapWindow(display, window);
    XSync(display, False);
    return window;
}

// Creates a window with that number on DISPLAY, on a connection that represents another program.
void makeStranger(::Window number) {
    Display* connections[kMaxTries];
    for (Display*& display : connections) {
        display = openDisplay("DISPLAY");
        const XVisualInfo* visual = visualOf(display);
        for (int i = 0; i < kMaxTries; ++i) {
            const ::Window made = makeWindow(display, *visual, 0x123456);
            if (made == number) return;
            XDestroyWindow(display, made);
            if (made > number) break;
        }
    }
    fail("no window of DISPLAY gets the number 0x%lx", number);
}

unsigned long sumOf(Display* display, ::Window window) {
    XImage* image = XGetImage(display, window, 0, 0, kWidth, kHeight, AllPlanes, ZPixmap);
    if (!image) fail("a window can't be read");
    unsigned long sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) sum = sum * 31 + (XGetPixel(image, x, y) & 0xffffff);
    XDestroyImage(image);
    return sum;
}

struct Shown {
    EGLDisplay display = nullptr; // null: by GLX
    EGLSurface surface = nullptr;
    Display* x = nullptr;
    ::Window window = 0;
};

Shown openGlx(Display* display, ::Window window, XVisualInfo* visual) {
    if (!glXMakeCurrent(display, window, glXCreateContext(display, visual, nullptr, True)))
        fail("glXMakeCurrent failed");
    return {nullptr, nullptr, display, window};
}

EGLDisplay eglDisplayOf(Display* display, const char* way) {
    const char* name = std::getenv("OTHER_DISPLAY");
    const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYPROC>(eglGetProcAddress("eglGetPlatformDisplay"));
    if (std::strcmp(way, "egl") == 0) return get(EGL_PLATFORM_X11_KHR, display, nullptr);
    if (std::strcmp(way, "xcb") == 0) return get(EGL_PLATFORM_XCB_EXT, xcb_connect(name, nullptr), nullptr);
    setenv("DISPLAY", name, 1);
    return eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

Shown openEgl(Display* display, ::Window window, const char* way) {
    EGLDisplay egl = eglDisplayOf(display, way);
    if (!egl || eglInitialize(egl, nullptr, nullptr) != EGL_TRUE) fail("no EGL display");
    eglBindAPI(EGL_OPENGL_API);
    const EGLint wanted[] = {
        EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8, EGL_ALPHA_SIZE, 0,
        EGL_NONE};
    EGLConfig configs[64];
    EGLint count = 0;
    eglChooseConfig(egl, wanted, configs, 64, &count);
    for (int i = 0; i < count; ++i) {
        EGLSurface surface = eglCreateWindowSurface(egl, configs[i], window, nullptr);
        if (surface &&
            eglMakeCurrent(egl, surface, surface, eglCreateContext(egl, configs[i], nullptr, nullptr)) == EGL_TRUE)
            return {egl, surface, display, window};
    }
    fail("no surface for the window");
}

void showFrames(const Shown& shown, float red);

// Shows frames alternately in this window and in the window of the other display.
void showOnBoth(const Shown& shown, Display* display) {
    XVisualInfo* visual = visualOf(display);
    const ::Window window = makeWindow(display, *visual, 0xffffff);
    const Shown here = openGlx(display, window, visual);
    showFrames(here, 0.8F);
    GLXContext again = glXCreateContext(shown.x, visualOf(shown.x), nullptr, True);
    glXMakeCurrent(shown.x, shown.window, again);
    showFrames(shown, 0.4F);
    std::printf("here %08lx\n", sumOf(display, window));
}

void swap(const Shown& shown) {
    if (shown.display)
        eglSwapBuffers(shown.display, shown.surface);
    else
        glXSwapBuffers(shown.x, shown.window);
}

void showFrames(const Shown& shown, float red) {
    for (int frame = 0; frame < 4; ++frame) {
        glClearColor(red, 0.5F, 0.25F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        showBits(2, std::uint32_t{77});
        swap(shown); // another connection may see it only before the next swap
    }
}

} // namespace

int main(int argc, char** argv) {
    const char* way = argc > 1 ? argv[1] : "glx";
    Display* other = openDisplay("OTHER_DISPLAY");
    XVisualInfo* visual = visualOf(other);
    const ::Window window = makeWindow(other, *visual, 0xffffff);
    makeStranger(window);
    Display* observer = openDisplay("DISPLAY");
    std::printf("stranger %08lx\n", sumOf(observer, window));
    const bool glx = std::strcmp(way, "glx") == 0 || std::strcmp(way, "both") == 0;
    const Shown shown = glx ? openGlx(other, window, visual) : openEgl(other, window, way);
    showFrames(shown, 0.2F);
    if (std::strcmp(way, "both") == 0) showOnBoth(shown, observer);
    std::printf("window %08lx\n", sumOf(other, window));
    std::printf("stranger %08lx\n", sumOf(observer, window));
    return 0;
}
