// Pbuffers that are drawn to while they are bound as textures (eglBindTexImage): the textures show the new contents.
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
    GLuint textures[2];
    glGenTextures(2, textures);
    for (int i = 0; i < 2; ++i) {
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        bindPbufferSource(sources[i]);
    }
    for (int frame = 0; frame < options.frames; ++frame) {
        for (unsigned i = 0; i < 2; ++i) { // the second changes only in every other frame
            if (i == 0 || frame % 2 == 0) {
                drawPbufferSource(sources[i], unsigned(frame) * 2 + i);
            }
        }
        window->makeCurrent();
        glClearColor(0.3F, 0.2F, 0.1F * float(frame % 8), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (int i = 0; i < 2; ++i) {
            glBindTexture(GL_TEXTURE_2D, textures[i]);
            drawTexturedQuad(-0.9F + 0.95F * float(i), -0.6F, 0.8F, 1.2F);
        }
        checkNoError("with pbuffers as textures");
        window->swap();
    }
    return 0;
}
