// One X window or EGL pbuffer with its own connection and context, for programs about processes. Each process may have
// several, made before or after a fork. Pixels are printed as a sum, so that two runs can be compared.
#pragma once

#define GL_GLEXT_PROTOTYPES 1
#include <EGL/egl.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "tests/programs/support/program.hpp"

namespace programs {

constexpr int kPlainSide = 200;

struct Plain {
    Display* display = nullptr;
    ::Window window = 0;
    GLXContext context = nullptr;
    EGLDisplay eglDisplay = nullptr;
    EGLSurface surface = nullptr;

    void show() const {
        if (window != 0)
            glXSwapBuffers(display, window);
        else
            glFlush(); // pbuffers show nothing
    }
};

inline XVisualInfo* plainVisual(Display* display) {
    int attributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8,   GLX_GREEN_SIZE, 8, GLX_BLUE_SIZE,
                        8,        GLX_DEPTH_SIZE,   24,           None};
    XVisualInfo* visual = glXChooseVisual(display, DefaultScreen(display), attributes);
    if (visual == nullptr) fail("no visual fits");
    return visual;
}

inline ::Window plainWindow(Display* display, const XVisualInfo& visual) {
    XSetWindowAttributes attributes{};
    attributes.colormap = XCreateColormap(display, RootWindow(display, visual.screen), visual.visual, AllocNone);
    const ::Window window =
        XCreateWindow(display, RootWindow(display, visual.screen), 0, 0, kPlainSide, kPlainSide, 0, visual.depth,
                      InputOutput, visual.visual, CWColormap | CWBorderPixel, &attributes);
    XMapWindow(display, window);
    XSync(display, False);
    return window;
}

// Creates the drawable; it is not current yet.
inline Plain makeGlx(Display* on = nullptr, GLXContext share = nullptr) {
    Plain made;
    made.display = on != nullptr ? on : XOpenDisplay(nullptr);
    if (made.display == nullptr) fail("no X display");
    XVisualInfo* visual = plainVisual(made.display);
    made.window = plainWindow(made.display, *visual);
    made.context = glXCreateContext(made.display, visual, share, True);
    XFree(visual);
    if (made.context == nullptr) fail("no GLX context");
    return made;
}

inline Plain openGlx() {
    Plain made = makeGlx();
    if (glXMakeCurrent(made.display, made.window, made.context) != True) fail("glXMakeCurrent failed");
    return made;
}

// Creates a pbuffer on an X connection of its own, with desktop GL.
inline Plain openEgl() {
    Plain made;
    made.display = XOpenDisplay(nullptr);
    made.eglDisplay = eglGetDisplay(made.display);
    if (eglInitialize(made.eglDisplay, nullptr, nullptr) != EGL_TRUE) fail("no EGL");
    const EGLint wanted[] = {
        EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8, EGL_DEPTH_SIZE, 24,
        EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(made.eglDisplay, wanted, &config, 1, &count) != EGL_TRUE || count == 0)
        fail("no EGL configuration fits");
    eglBindAPI(EGL_OPENGL_API);
    const EGLint size[] = {EGL_WIDTH, kPlainSide, EGL_HEIGHT, kPlainSide, EGL_NONE};
    made.surface = eglCreatePbufferSurface(made.eglDisplay, config, size);
    const EGLContext context = eglCreateContext(made.eglDisplay, config, EGL_NO_CONTEXT, nullptr);
    if (eglMakeCurrent(made.eglDisplay, made.surface, made.surface, context) != EGL_TRUE) fail("eglMakeCurrent failed");
    return made;
}

// Draws a picture that depends on the frame number.
inline void drawPlain(int frame) {
    glViewport(0, 0, kPlainSide, kPlainSide);
    glClearColor(0.1F, 0.1F, 0.05F * float(frame % 12), 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 30; ++i) {
        const auto at = [&](int k) { return float((i * 37 + frame * 11 + k * 53) % 97) / 48.0F - 1.0F; };
        glColor3f(at(1) * 0.5F + 0.5F, at(2) * 0.5F + 0.5F, at(3) * 0.5F + 0.5F);
        glVertex3f(at(4), at(5), at(6));
    }
    glEnd();
}

inline uint64_t readPlain() {
    std::vector<uint8_t> pixels(size_t(kPlainSide) * kPlainSide * 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, kPlainSide, kPlainSide, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    uint64_t sum = 1469598103934665603U;
    for (const uint8_t byte : pixels) sum = (sum ^ byte) * 1099511628211U;
    return sum;
}

inline void drawFrames(const Plain& plain, int first, int count) {
    for (int i = 0; i < count; ++i) {
        drawPlain(first + i);
        plain.show();
    }
}

// Draws one frame, reads it before it is shown, and prints the sum and the error.
inline void printFrame(const char* who, const Plain& plain, int frame) {
    drawPlain(frame);
    const uint64_t sum = readPlain();
    std::printf("%s %d: %016llx error %x\n", who, frame, static_cast<unsigned long long>(sum), glGetError());
    std::fflush(stdout);
    plain.show();
}

} // namespace programs
