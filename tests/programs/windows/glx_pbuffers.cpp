// GLX pbuffers and pixmaps: drawn into, read and shown in the window, read while drawing into the window, kept over
// frames, created and destroyed in between.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/glx_choice.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <GL/glx.h>
#include <vector>

#include "tests/programs/support/x_window.hpp"

using namespace programs;

namespace {

constexpr int kSize = 64;
Display* display;

GLXPbuffer makePbuffer(GLXFBConfig config) {
    const int attributes[] = {GLX_PBUFFER_WIDTH, kSize, GLX_PBUFFER_HEIGHT, kSize, GLX_PRESERVED_CONTENTS, True, None};
    return glXCreatePbuffer(display, config, attributes);
}

void drawShapes(unsigned seed, bool clear) {
    glViewport(0, 0, kSize, kSize);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    Sequence numbers(seed);
    if (clear) {
        glClearColor(numbers.unit(), 0.2F, 0.3F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    }
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 9; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
}

void require(Bool made, const char* what) {
    if (made != True) {
        fail("can't make current: %s", what);
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    const GLXFBConfig config = chooseGlxConfig(display, GLX_WINDOW_BIT | GLX_PBUFFER_BIT | GLX_PIXMAP_BIT, 24);
    XVisualInfo* visual = glXGetVisualFromFBConfig(display, config);
    const XWindow window(*visual, 0, 0, options.width, options.height);
    const GLXContext context = glXCreateNewContext(display, config, GLX_RGBA_TYPE, nullptr, True);
    const GLXPbuffer permanent = makePbuffer(config);
    const Pixmap pixmap = XCreatePixmap(display, window.id(), kSize, kSize, unsigned(visual->depth));
    const GLXPixmap glxPixmap = glXCreatePixmap(display, config, pixmap, nullptr);
    std::vector<GLubyte> pixels(kSize * kSize * 4);
    for (int frame = 0; frame < options.frames; ++frame) {
        const GLXPbuffer fresh = makePbuffer(config);
        require(glXMakeContextCurrent(display, fresh, fresh, context), "a new pbuffer");
        drawShapes(unsigned(frame) + 5, true);
        glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        require(glXMakeContextCurrent(display, permanent, permanent, context), "the kept pbuffer");
        drawShapes(unsigned(frame) + 90, frame == 0); // over the earlier frames
        require(glXMakeContextCurrent(display, glxPixmap, glxPixmap, context), "the pixmap");
        std::vector<GLubyte> others(kSize * kSize * 4);
        drawShapes(unsigned(frame) + 40, true);
        glReadPixels(0, 0, kSize, kSize, GL_BGRA, GL_UNSIGNED_BYTE, others.data());
        require(glXMakeContextCurrent(display, window.id(), permanent, context), "the window, reading the pbuffer");
        glViewport(0, 0, options.width, options.height);
        glClearColor(0.1F, 0.1F, 0.1F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glWindowPos2i(10, 10);
        glDrawPixels(kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        glWindowPos2i(90, 10);
        glCopyPixels(0, 0, kSize, kSize, GL_COLOR);
        glWindowPos2i(170, 10);
        glDrawPixels(kSize, kSize, GL_BGRA, GL_UNSIGNED_BYTE, others.data());
        checkNoError("in the window");
        require(glXMakeContextCurrent(display, window.id(), window.id(), context), "the window");
        glXSwapBuffers(display, window.id());
        glXDestroyPbuffer(display, fresh);
    }
    glXMakeContextCurrent(display, None, None, nullptr);
    glXDestroyPixmap(display, glxPixmap);
    glXDestroyContext(display, context);
    return 0;
}
