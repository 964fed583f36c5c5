#include "tests/programs/support/pbuffer_source.hpp"

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

namespace programs {

namespace {
constexpr int kSize = 64;
} // namespace

PbufferSource makePbufferSource(EGLDisplay display, bool alpha) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_ALPHA_SIZE,
                             alpha ? 8 : 0,
                             alpha ? EGL_BIND_TO_TEXTURE_RGBA : EGL_BIND_TO_TEXTURE_RGB,
                             EGL_TRUE,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE || count == 0) {
        fail("no EGL configuration for pbuffers as textures");
    }
    const EGLint size[] = {EGL_WIDTH,
                           kSize,
                           EGL_HEIGHT,
                           kSize,
                           EGL_TEXTURE_TARGET,
                           EGL_TEXTURE_2D,
                           EGL_TEXTURE_FORMAT,
                           alpha ? EGL_TEXTURE_RGBA : EGL_TEXTURE_RGB,
                           EGL_NONE};
    const PbufferSource made = {display, eglCreatePbufferSurface(display, config, size),
                                eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr)};
    if (made.surface == EGL_NO_SURFACE || made.context == EGL_NO_CONTEXT) {
        fail("no pbuffer for a texture (EGL error 0x%04x)", eglGetError());
    }
    return made;
}

void drawPbufferSource(const PbufferSource& s, unsigned seed) {
    if (eglMakeCurrent(s.display, s.surface, s.surface, s.context) != EGL_TRUE) {
        fail("eglMakeCurrent of a pbuffer failed (EGL error 0x%04x)", eglGetError());
    }
    Sequence numbers(seed);
    glClearColor(numbers.unit(), 0.2F, numbers.unit(), 0.5F);
    glClear(GL_COLOR_BUFFER_BIT);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 15; ++i) {
        glColor4f(numbers.unit(), numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
    glFinish();
    checkNoError("in a pbuffer");
}

void bindPbufferSource(const PbufferSource& s) {
    if (eglBindTexImage(s.display, s.surface, EGL_BACK_BUFFER) != EGL_TRUE) {
        fail("eglBindTexImage failed (EGL error 0x%04x)", eglGetError());
    }
}

} // namespace programs
