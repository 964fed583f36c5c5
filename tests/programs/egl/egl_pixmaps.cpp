// Draws into X pixmaps through EGL surfaces of both kinds. The pixels that GL reads from them are shown in a window.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <EGL/egl.h>
#include <array>
#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 32;

void require(bool ok, const char* what) {
    if (!ok) {
        fail("cannot use %s, EGL error 0x%x", what, unsigned(eglGetError()));
    }
}

// Draws, and returns a sum of the pixels.
std::uint32_t drawAndRead(unsigned seed) {
    Sequence numbers(seed);
    glClearColor(numbers.unit(), numbers.unit(), numbers.unit(), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    for (int i = 0; i < 6; ++i) {
        fillRectangle(i * 5, i * 4, 7, 9, {numbers.unit(), numbers.unit(), numbers.unit()});
    }
    std::vector<GLubyte> pixels(kSize * kSize * 4);
    glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    checkNoError("in a pixmap");
    std::uint32_t sum = 1;
    for (const GLubyte value : pixels) {
        sum = sum * 31 + value;
    }
    return sum;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openEglWindow({.profile = Profile::Compatibility}, options.width, options.height);
    Display* x = openDisplayOnce();
    const EGLDisplay egl = eglGetDisplay(reinterpret_cast<EGLNativeDisplayType>(x));
    const EGLint attributes[] = {
        EGL_SURFACE_TYPE,    EGL_PIXMAP_BIT, EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8,
        EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    require(eglChooseConfig(egl, attributes, &config, 1, &count) == EGL_TRUE && count == 1, "pixmaps");
    EGLint visual = 0;
    eglGetConfigAttrib(egl, config, EGL_NATIVE_VISUAL_ID, &visual);
    XVisualInfo wanted{};
    wanted.visualid = VisualID(visual);
    int visuals = 0;
    const XVisualInfo* info = XGetVisualInfo(x, VisualIDMask, &wanted, &visuals);
    require(info != nullptr, "the visual of pixmaps");
    require(eglBindAPI(EGL_OPENGL_API) == EGL_TRUE, "desktop OpenGL");
    const EGLContext context = eglCreateContext(egl, config, EGL_NO_CONTEXT, nullptr);
    for (int frame = 0; frame < options.frames; ++frame) {
        std::array<std::uint32_t, 2> sums{};
        for (unsigned i = 0; i < 2; ++i) {
            Pixmap pixmap = XCreatePixmap(x, DefaultRootWindow(x), kSize, kSize, unsigned(info->depth));
            const EGLSurface surface = i == 0 ? eglCreatePixmapSurface(egl, config, pixmap, nullptr)
                                              : eglCreatePlatformPixmapSurface(egl, config, &pixmap, nullptr);
            require(eglMakeCurrent(egl, surface, surface, context) == EGL_TRUE, "a pixmap");
            sums[i] = drawAndRead(unsigned(frame) * 2 + i);
            window->makeCurrent();
            eglDestroySurface(egl, surface);
            XFreePixmap(x, pixmap);
        }
        glClearColor(0.1F, 0.2F, 0.3F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        showBits(0, sums[0]);
        showBits(1, sums[1]);
        window->swap();
    }
    return 0;
}
