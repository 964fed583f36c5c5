// Prints how many values of new drawables are not 0: windows of several visuals before and after they grow, and
// pbuffers.
#include <GL/glx.h>
#include <cstdio>
#include <unistd.h>
#include <vector>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/glx_choice.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/surfaces/image_sum.hpp"

using namespace programs;

namespace {

Display* display;

int notZero(const std::vector<GLubyte>& bytes, std::size_t first, std::size_t step, std::size_t count) {
    int found = 0;
    for (std::size_t i = 0; i < bytes.size(); i += step) {
        for (std::size_t k = 0; k < count; ++k) {
            found += bytes[i + first + k] != 0;
        }
    }
    return found;
}

void printBuffers(const char* what, GLenum buffer, int width, int height) {
    const auto pixels = std::size_t(width) * std::size_t(height);
    std::vector<GLubyte> colours(pixels * 4, 9), depths(pixels * 4, 9), stencils(pixels, 9);
    glReadBuffer(buffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, colours.data());
    glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
    glReadPixels(0, 0, width, height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencils.data());
    checkNoError(what);
    std::printf("%s %s %dx%d: colour %d alpha %d depth %d stencil %d\n", what, buffer == GL_BACK ? "back" : "front",
                width, height, notZero(colours, 0, 4, 3), notZero(colours, 3, 4, 1), notZero(depths, 0, 4, 4),
                notZero(stencils, 0, 1, 1));
}

// Fills memory of the drawing process with a pattern, and frees it.
void fillAndFree(GLXFBConfig config, GLXContext context, int width, int height) {
    const int attributes[] = {GLX_PBUFFER_WIDTH, width, GLX_PBUFFER_HEIGHT, height, None};
    std::vector<GLXPbuffer> pbuffers;
    for (int i = 0; i < 3; ++i) {
        pbuffers.push_back(glXCreatePbuffer(display, config, attributes));
        glXMakeContextCurrent(display, pbuffers.back(), pbuffers.back(), context);
        glClearColor(0.6F, 0.7F, 0.8F, 0.9F);
        glClearDepth(0.3);
        glClearStencil(0x5a);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
        const std::vector<GLubyte> pattern(std::size_t(width) * std::size_t(height) * 4, 0xa5);
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pattern.data());
        glDeleteTextures(1, &texture);
        glFinish();
    }
    glXMakeContextCurrent(display, None, None, nullptr);
    for (const GLXPbuffer pbuffer : pbuffers) {
        glXDestroyPbuffer(display, pbuffer);
    }
}

struct Kind {
    const char* name;
    int alpha, doubled, samples;
};

GLXFBConfig choose(const Kind& kind) {
    const int attributes[] = {GLX_X_RENDERABLE,
                              True,
                              GLX_DRAWABLE_TYPE,
                              GLX_WINDOW_BIT | GLX_PBUFFER_BIT,
                              GLX_RENDER_TYPE,
                              GLX_RGBA_BIT,
                              GLX_RED_SIZE,
                              8,
                              GLX_ALPHA_SIZE,
                              kind.alpha,
                              GLX_DEPTH_SIZE,
                              24,
                              GLX_STENCIL_SIZE,
                              8,
                              GLX_DOUBLEBUFFER,
                              kind.doubled,
                              GLX_SAMPLES,
                              kind.samples,
                              None};
    int count = 0;
    GLXFBConfig* const found = glXChooseFBConfig(display, DefaultScreen(display), attributes, &count);
    for (int i = 0; i < count; ++i) {
        XVisualInfo* const visual = glXGetVisualFromFBConfig(display, found[i]);
        const bool fits = visual != nullptr && visual->depth == DefaultDepth(display, DefaultScreen(display));
        XFree(visual);
        if (fits) {
            return found[i];
        }
    }
    fail("no configuration \"%s\"", kind.name);
}

void testWindow(const Kind& kind, GLXFBConfig config, GLXContext context, int width, int height) {
    XVisualInfo* const visual = glXGetVisualFromFBConfig(display, config);
    XWindow window(*visual, 0, 0, width, height);
    const GLenum back = kind.doubled != 0 ? GL_BACK : GL_FRONT;
    glXMakeContextCurrent(display, window.id(), window.id(), context);
    glDrawBuffer(back);
    printBuffers(kind.name, back, width, height);
    if (kind.doubled != 0) {
        printBuffers(kind.name, GL_FRONT, width, height);
    }
    glXSwapBuffers(display, window.id());
    glFlush();
    printShown(kind.name, window.id(), width, height);
    glEnable(GL_SCISSOR_TEST); // only a part, across the tiles of several nodes
    glScissor(width / 4, height / 4, width / 2, height / 2);
    glClearColor(1, 0.5F, 0.25F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    glXSwapBuffers(display, window.id());
    glFlush();
    printShown("a part", window.id(), width, height);
    window.resize(width + 40, height + 24);
    glXSwapBuffers(display, window.id());
    if (kind.doubled != 0) { // natively a single buffer takes the new size later
        printBuffers("grown", back, width + 40, height + 24);
        glXSwapBuffers(display, window.id());
        printShown("grown", window.id(), width + 40, height + 24);
    }
    glXMakeContextCurrent(display, None, None, nullptr);
}

void testPbuffer(const Kind& kind, GLXFBConfig config, GLXContext context, int width, int height) {
    const int attributes[] = {GLX_PBUFFER_WIDTH, width, GLX_PBUFFER_HEIGHT, height, None};
    const GLXPbuffer pbuffer = glXCreatePbuffer(display, config, attributes);
    glXMakeContextCurrent(display, pbuffer, pbuffer, context);
    printBuffers("pbuffer", kind.doubled != 0 ? GL_BACK : GL_FRONT, width, height);
    if (kind.doubled != 0) {
        printBuffers("pbuffer", GL_FRONT, width, height);
    }
    glXMakeContextCurrent(display, None, None, nullptr);
    glXDestroyPbuffer(display, pbuffer);
}

} // namespace

int main(int argc, char** argv) {
    (void)parseOptions(argc, argv);
    display = openDisplayOnce();
    for (const Kind& kind : {Kind{"window", 0, True, 0}, Kind{"window with alpha", 8, True, 0},
                             Kind{"window with one buffer", 0, False, 0}, Kind{"window with samples", 0, True, 4}}) {
        const GLXFBConfig config = choose(kind);
        const GLXContext context = glXCreateNewContext(display, config, GLX_RGBA_TYPE, nullptr, True);
        for (const auto& [width, height] : {std::pair{16, 16}, {160, 96}}) {
            fillAndFree(config, context, width, height);
            testWindow(kind, config, context, width, height);
            fillAndFree(config, context, width, height);
            testPbuffer(kind, config, context, width, height);
        }
        glXDestroyContext(display, context);
    }
    return 0;
}
