// Draws into one drawable and reads from another (glXMakeContextCurrent): windows, pbuffers and pixmaps in all pairs,
// with glReadPixels, glCopyPixels, glCopyTexImage2D and glBlitFramebuffer.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/glx_choice.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <GL/glx.h>

using namespace programs;

namespace {

constexpr int kSize = 50;

Display* display;
GLXContext context;

void use(GLXDrawable draw, GLXDrawable read) {
    if (glXMakeContextCurrent(display, draw, read, context) != True) {
        fail("glXMakeContextCurrent failed");
    }
}

void drawShapes(unsigned seed, int width, int height) {
    Sequence numbers(seed);
    glViewport(0, 0, width, height);
    glClearColor(numbers.unit(), numbers.unit(), 0.3F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 18; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
}

// Copies part of `read` into `draw`, in four ways.
void mix(GLXDrawable draw, GLXDrawable read, int x, int y) {
    use(draw, read);
    GLubyte pixels[20 * 15 * 4];
    glReadPixels(5, 6, 20, 15, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    glWindowPos2i(x, y);
    glDrawPixels(20, 15, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    glWindowPos2i(x + 22, y);
    glCopyPixels(12, 3, 16, 18, GL_COLOR);
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 8, 9, 32, 32, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glEnable(GL_TEXTURE_2D);
    glColor3f(1, 1, 1);
    glBegin(GL_QUADS);
    for (int i = 0; i < 4; ++i) {
        const float u = i == 1 || i == 2 ? 1 : 0, v = i >= 2 ? 1 : 0;
        glTexCoord2f(u, v);
        glVertex2f(-0.9F + u * 0.3F, 0.5F + v * 0.4F);
    }
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glDeleteTextures(1, &texture);
    glBlitFramebuffer(0, 0, 30, 30, x + 40, y + 4, x + 55, y + 34, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    checkNoError("reading from another drawable");
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    const GLXFBConfig config = chooseGlxConfig(display, GLX_WINDOW_BIT | GLX_PBUFFER_BIT | GLX_PIXMAP_BIT, 24);
    XVisualInfo* visual = glXGetVisualFromFBConfig(display, config);
    const XWindow first(*visual, 0, 0, options.width, options.height);
    const XWindow second(*visual, options.width, 0, options.width / 2, options.height / 2);
    const int size[] = {GLX_PBUFFER_WIDTH, kSize, GLX_PBUFFER_HEIGHT, kSize, GLX_PRESERVED_CONTENTS, True, None};
    const GLXWindow windows[] = {glXCreateWindow(display, config, first.id(), nullptr),
                                 glXCreateWindow(display, config, second.id(), nullptr)};
    const GLXPbuffer pbuffers[] = {glXCreatePbuffer(display, config, size), glXCreatePbuffer(display, config, size)};
    const Pixmap pixmap = XCreatePixmap(display, first.id(), kSize, kSize, unsigned(visual->depth));
    const GLXPixmap glxPixmap = glXCreatePixmap(display, config, pixmap, nullptr);
    context = glXCreateNewContext(display, config, GLX_RGBA_TYPE, nullptr, True);
    for (int frame = 0; frame < options.frames; ++frame) {
        const auto seed = unsigned(frame * 10);
        use(pbuffers[0], pbuffers[0]);
        drawShapes(seed + 1, kSize, kSize);
        use(glxPixmap, glxPixmap);
        drawShapes(seed + 2, kSize, kSize);
        mix(glxPixmap, pbuffers[0], 2, 20);
        use(windows[1], windows[1]);
        drawShapes(seed + 3, options.width / 2, options.height / 2);
        mix(windows[1], glxPixmap, 3, 5);
        mix(pbuffers[1], windows[1], 1, 2);
        mix(pbuffers[0], pbuffers[1], 4, 3);
        use(windows[0], windows[0]);
        drawShapes(seed + 4, options.width, options.height);
        mix(windows[0], windows[1], 20, 30);
        mix(windows[0], pbuffers[0], 110, 70);
        mix(windows[0], glxPixmap, 30, 110);
        glXSwapBuffers(display, windows[0]);
        glXSwapBuffers(display, windows[1]);
    }
    return 0;
}
