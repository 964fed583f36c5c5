// Pbuffers that become textures (eglBindTexImage): drawn with a context of their own, bound in the window's context.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/pbuffer_source.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/textured_quad.hpp"

using namespace programs;

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openEglWindow({}, options.width, options.height);
    window->makeCurrent();
    EGLDisplay display = eglGetCurrentDisplay();
    const PbufferSource sources[] = {makePbufferSource(display, false), makePbufferSource(display, true)};
    GLuint textures[2], framebuffer = 0;
    glGenTextures(2, textures);
    glGenFramebuffers(1, &framebuffer);
    for (int frame = 0; frame < options.frames; ++frame) {
        for (unsigned i = 0; i < 2; ++i) {
            drawPbufferSource(sources[i], unsigned(frame) * 2 + i);
        }
        window->makeCurrent();
        glClearColor(0.3F, 0.2F, 0.1F * float(frame % 8), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (int i = 0; i < 2; ++i) {
            glBindTexture(GL_TEXTURE_2D, textures[i]);
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
            if (i == 1) { // a bound framebuffer object must not affect the pbuffer
                glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
            }
            bindPbufferSource(sources[i]);
            glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
            drawTexturedQuad(-0.9F + 0.95F * float(i), -0.6F, 0.8F, 1.2F);
            eglReleaseTexImage(display, sources[i].surface, EGL_BACK_BUFFER);
        }
        checkNoError("with pbuffers as textures");
        window->swap();
    }
    return 0;
}
