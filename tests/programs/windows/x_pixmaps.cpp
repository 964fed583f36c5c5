// Draws into X pixmaps created as in GLX 1.2 programs. The pixels that GL and X read from them are shown in the window.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <GL/glx.h>
#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 64;

Display* display;
XVisualInfo* visual;
GLXContext context;

void require(bool ok, const char* what) {
    if (!ok) {
        fail("cannot use %s", what);
    }
}

void drawShapes(unsigned seed) {
    Sequence numbers(seed);
    glViewport(0, 0, kSize, kSize);
    glClearColor(numbers.unit(), numbers.unit(), 0.5F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 12; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
}

struct Drawn {
    std::vector<GLubyte> byGl = std::vector<GLubyte>(kSize * kSize * 4);
    std::vector<GLubyte> byX = std::vector<GLubyte>(kSize * kSize * 4);
};

void readByX(Pixmap pixmap, std::vector<GLubyte>& pixels) {
    XImage* image = XGetImage(display, pixmap, 0, 0, kSize, kSize, AllPlanes, ZPixmap);
    if (!image) {
        fail("the X server gives no image of the pixmap");
    }
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const unsigned long value = XGetPixel(image, x, kSize - 1 - y);
            GLubyte* pixel = &pixels[size_t(y * kSize + x) * 4];
            pixel[0] = GLubyte(value >> 16);
            pixel[1] = GLubyte(value >> 8);
            pixel[2] = GLubyte(value);
            pixel[3] = 255;
        }
    }
    XDestroyImage(image);
}

Drawn drawInto(Pixmap pixmap, GLXPixmap drawable, unsigned seed) {
    Drawn drawn;
    require(glXMakeCurrent(display, drawable, context), "the pixmap");
    drawShapes(seed);
    glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, drawn.byGl.data());
    glFinish();
    glXWaitGL();
    readByX(pixmap, drawn.byX);
    checkNoError("in the pixmap");
    return drawn;
}

void show(const Drawn& drawn, int x) {
    glWindowPos2i(x, 5);
    glDrawPixels(kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, drawn.byGl.data());
    glWindowPos2i(x, 80);
    glDrawPixels(kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, drawn.byX.data());
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    int attributes[] = {GLX_RGBA, GLX_RED_SIZE,   8,  GLX_GREEN_SIZE,   8,   GLX_BLUE_SIZE,
                        8,        GLX_DEPTH_SIZE, 16, GLX_DOUBLEBUFFER, None};
    visual = glXChooseVisual(display, DefaultScreen(display), attributes);
    require(visual, "a visual with two buffers");
    const XWindow window(*visual, 0, 0, options.width, options.height);
    context = glXCreateContext(display, visual, nullptr, True);
    require(context, "a context");
    const Pixmap pixmap = XCreatePixmap(display, window.id(), kSize, kSize, unsigned(visual->depth));
    const GLXPixmap permanent = glXCreateGLXPixmap(display, visual, pixmap);
    for (int frame = 0; frame < options.frames; ++frame) {
        const Pixmap second = XCreatePixmap(display, window.id(), kSize, kSize, unsigned(visual->depth));
        const GLXPixmap fresh = glXCreateGLXPixmap(display, visual, second);
        const Drawn drawn[] = {drawInto(pixmap, permanent, unsigned(frame) + 3),
                               drawInto(second, fresh, unsigned(frame) + 70)};
        require(glXMakeCurrent(display, window.id(), context), "the window");
        glViewport(0, 0, options.width, options.height);
        glClearColor(0.1F, 0.2F, 0.1F * float(frame % 4), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        show(drawn[0], 5);
        show(drawn[1], 80);
        checkNoError("in the window");
        glXSwapBuffers(display, window.id());
        glXDestroyGLXPixmap(display, fresh);
        XFreePixmap(display, second);
    }
    glXMakeCurrent(display, None, nullptr);
    glXDestroyGLXPixmap(display, permanent);
    glXDestroyContext(display, context);
    return 0;
}
