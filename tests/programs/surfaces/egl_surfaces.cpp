// Prints the contents of new EGL surfaces, and which surfaces eglSwapBuffers shows.
#include <EGL/egl.h>
#include <cstdio>
#include <thread>
#include <vector>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/surfaces/image_sum.hpp"

using namespace programs;

namespace {

EGLDisplay egl;

void printNew(const char* what, int width, int height) {
    const auto pixels = std::size_t(width) * std::size_t(height);
    std::vector<GLubyte> colours(pixels * 4, 9);
    std::vector<GLfloat> depths(pixels, 9);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, colours.data());
    glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
    int lit = 0, alpha = 0, deep = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        lit += colours[4 * i] != 0 || colours[4 * i + 1] != 0 || colours[4 * i + 2] != 0;
        alpha += colours[4 * i + 3] != 0;
        deep += depths[i] != 0;
    }
    checkNoError(what);
    std::printf("%s %dx%d: %d lit, alpha %d, depth %d\n", what, width, height, lit, alpha, deep);
}

void fill(float red, float green, float blue) {
    glClearColor(red, green, blue, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

void printSwap(const char* what, EGLSurface surface) {
    const EGLBoolean ok = eglSwapBuffers(egl, surface);
    const EGLint error = eglGetError();
    std::printf("%s: swap gives %u, error %x\n", what, ok, static_cast<unsigned>(error));
}

EGLConfig choose(int alpha) {
    const EGLint attributes[] = {EGL_SURFACE_TYPE,
                                 EGL_WINDOW_BIT | EGL_PBUFFER_BIT,
                                 EGL_RENDERABLE_TYPE,
                                 EGL_OPENGL_BIT,
                                 EGL_RED_SIZE,
                                 8,
                                 EGL_ALPHA_SIZE,
                                 alpha,
                                 EGL_DEPTH_SIZE,
                                 24,
                                 EGL_STENCIL_SIZE,
                                 8,
                                 EGL_NONE};
    EGLConfig found = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(egl, attributes, &found, 1, &count) || count == 0) {
        fail("no configuration");
    }
    return found;
}

void test(int alpha, int width, int height) {
    const EGLConfig config = choose(alpha);
    XVisualInfo pattern{};
    EGLint id = 0;
    eglGetConfigAttrib(egl, config, EGL_NATIVE_VISUAL_ID, &id);
    pattern.visualid = VisualID(id);
    int count = 0;
    XVisualInfo* const visual = XGetVisualInfo(openDisplayOnce(), VisualIDMask, &pattern, &count);
    XWindow window(*visual, 0, 0, width, height);
    const EGLContext context = eglCreateContext(egl, config, EGL_NO_CONTEXT, nullptr);
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    EGLSurface pbuffer = eglCreatePbufferSurface(egl, config, size);
    const EGLSurface shown = eglCreateWindowSurface(egl, config, window.id(), nullptr);
    for (int i = 0; i < 3; ++i) { // leaves free memory filled with this colour
        eglMakeCurrent(egl, pbuffer, pbuffer, context);
        fill(0.6F, 0.7F, 0.8F);
        glFinish();
        const EGLSurface old = pbuffer;
        pbuffer = eglCreatePbufferSurface(egl, config, size);
        eglMakeCurrent(egl, pbuffer, pbuffer, context);
        eglDestroySurface(egl, old);
        printNew("pbuffer", width, height);
    }
    eglMakeCurrent(egl, shown, shown, context);
    printNew("window", width, height);
    printSwap("never drawn", shown);
    printShown("never drawn", window.id(), width, height);
    window.resize(width + 30, height + 20);
    printSwap("grown", shown);
    printNew("grown", width + 30, height + 20);
    fill(1, 0, 0.5F);
    printSwap("drawn", shown);
    printShown("drawn", window.id(), width + 30, height + 20);
    fill(0, 1, 0.5F);
    eglMakeCurrent(egl, pbuffer, shown, context);
    printSwap("bound for reading alone", shown);
    printShown("bound for reading alone", window.id(), width + 30, height + 20);
    eglMakeCurrent(egl, shown, pbuffer, context);
    fill(0.25F, 1, 0.5F);
    printSwap("bound for drawing alone", shown);
    printShown("bound for drawing alone", window.id(), width + 30, height + 20);
    fill(0.5F, 1, 0.5F);
    glFinish();
    std::thread([&] { printSwap("another thread", shown); }).join();
    printShown("another thread", window.id(), width + 30, height + 20);
    eglMakeCurrent(egl, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    printSwap("nothing current", shown);
    printShown("nothing current", window.id(), width + 30, height + 20);
    eglDestroySurface(egl, shown);
    eglDestroySurface(egl, pbuffer);
    eglDestroyContext(egl, context);
    XFree(visual);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    egl = eglGetDisplay(openDisplayOnce());
    if (!eglInitialize(egl, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) {
        fail("EGL does not begin");
    }
    test(0, options.width, options.height);
    test(8, options.width / 2, options.height / 2);
    eglTerminate(egl);
    return 0;
}
