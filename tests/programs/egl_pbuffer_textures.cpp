// Pbuffers that become textures (eglBindTexImage): drawn by a context of their own, bound in the window's.
#include <EGL/egl.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/textured_quad.hpp"

using namespace programs;

namespace {

constexpr int kSize = 64;

EGLDisplay display;

struct Source {
    EGLSurface surface;
    EGLContext context;
};

Source makeSource(bool alpha) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8,
                             EGL_ALPHA_SIZE, alpha ? 8 : 0, alpha ? EGL_BIND_TO_TEXTURE_RGBA : EGL_BIND_TO_TEXTURE_RGB, EGL_TRUE, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE || count == 0) {
        fail("no EGL configuration for pbuffers as textures");
    }
    const EGLint size[] = {EGL_WIDTH, kSize, EGL_HEIGHT, kSize, EGL_TEXTURE_TARGET, EGL_TEXTURE_2D,
                           EGL_TEXTURE_FORMAT, alpha ? EGL_TEXTURE_RGBA : EGL_TEXTURE_RGB, EGL_NONE};
    const Source made = {eglCreatePbufferSurface(display, config, size), eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr)};
    if (made.surface == EGL_NO_SURFACE || made.context == EGL_NO_CONTEXT) {
        fail("no pbuffer for a texture (EGL error 0x%04x)", eglGetError());
    }
    return made;
}

void drawSource(const Source& s, unsigned seed) {
    if (eglMakeCurrent(display, s.surface, s.surface, s.context) != EGL_TRUE) {
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

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openEglWindow({}, options.width, options.height);
    window->makeCurrent();
    display = eglGetCurrentDisplay();
    const Source sources[] = {makeSource(false), makeSource(true)};
    GLuint textures[2], framebuffer = 0;
    glGenTextures(2, textures);
    glGenFramebuffers(1, &framebuffer);
    for (int frame = 0; frame < options.frames; ++frame) {
        for (unsigned i = 0; i < 2; ++i) {
            drawSource(sources[i], unsigned(frame) * 2 + i);
        }
        window->makeCurrent();
        glClearColor(0.3F, 0.2F, 0.1F * float(frame % 8), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (int i = 0; i < 2; ++i) {
            glBindTexture(GL_TEXTURE_2D, textures[i]);
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
            if (i == 1) { // a framebuffer of the program's is none of the pbuffer's business
                glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
            }
            if (eglBindTexImage(display, sources[i].surface, EGL_BACK_BUFFER) != EGL_TRUE) {
                fail("eglBindTexImage failed (EGL error 0x%04x)", eglGetError());
            }
            glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
            drawTexturedQuad(-0.9F + 0.95F * float(i), -0.6F, 0.8F, 1.2F);
            eglReleaseTexImage(display, sources[i].surface, EGL_BACK_BUFFER);
        }
        checkNoError("with pbuffers as textures");
        window->swap();
    }
    return 0;
}
