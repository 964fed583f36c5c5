// Prints the pixels of windows that are swapped while another window is current, by a thread with another context, or
// while they are bound only for reading. A window with one buffer is shown when its context is released.
#include <GL/glx.h>
#include <cstdio>
#include <thread>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/surfaces/image_sum.hpp"

using namespace programs;

namespace {

Display* display;

GLXFBConfig choose(int doubled) {
    const int attributes[] = {
        GLX_X_RENDERABLE, True, GLX_RED_SIZE, 8, GLX_DEPTH_SIZE, 24, GLX_STENCIL_SIZE, 8, GLX_DOUBLEBUFFER, doubled,
        GLX_SAMPLES,      0,    None};
    int count = 0;
    GLXFBConfig* const found = glXChooseFBConfig(display, DefaultScreen(display), attributes, &count);
    if (count == 0) {
        fail("no configuration");
    }
    return found[0];
}

// A window with a GLX window, whose buffers remain while no context is bound to it.
struct Drawn {
    Drawn(GLXFBConfig config, int x, int w, int h)
        : visual(glXGetVisualFromFBConfig(display, config)),
          window(*visual, x, 0, w, h),
          id(glXCreateWindow(display, config, window.id(), nullptr)),
          context(glXCreateNewContext(display, config, GLX_RGBA_TYPE, nullptr, True)),
          width(w),
          height(h) {}
    Drawn(const Drawn&) = delete;
    Drawn& operator=(const Drawn&) = delete;
    ~Drawn() {
        glXDestroyWindow(display, id);
        glXDestroyContext(display, context);
        XFree(visual);
    }

    void bind(GLXContext by) const { glXMakeContextCurrent(display, id, id, by); }
    void bind() const { bind(context); }
    void draw(int frame) const {
        glViewport(0, 0, width, height);
        glClearColor(0.1F * float(frame % 9), 0.3F, 0.5F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        Sequence numbers(unsigned(frame) + 7);
        glBegin(GL_TRIANGLES);
        for (int i = 0; i < 12; ++i) {
            glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
            glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
        }
        glEnd();
    }
    void print(const char* what) const { printShown(what, window.id(), width, height); }

    XVisualInfo* visual;
    XWindow window;
    GLXWindow id;
    GLXContext context;
    int width, height;
};

void release() { glXMakeContextCurrent(display, None, None, nullptr); }

void withOneContext(const Drawn& a, const Drawn& b) {
    for (int frame = 0; frame < 3; ++frame) {
        b.bind(a.context);
        b.draw(frame);
        a.bind();
        a.draw(frame + 20);
        glXSwapBuffers(display, b.id);
        glXSwapBuffers(display, a.id);
    }
    a.print("one context: current");
    b.print("one context: other");
    a.draw(3);
    glXMakeContextCurrent(display, b.id, a.id, a.context);
    glXSwapBuffers(display, a.id);
    a.print("bound for reading alone");
}

void withTwoContexts(const Drawn& a, const Drawn& b) {
    a.bind();
    a.draw(40);
    b.bind();
    b.draw(41);
    glXSwapBuffers(display, a.id);
    glXSwapBuffers(display, b.id);
    a.print("two contexts: other");
    b.print("two contexts: current");
    a.bind();
    a.draw(42);
    glFinish();
    std::thread([&] {
        b.bind();
        glXSwapBuffers(display, a.id);
        XSync(display, False);
        release();
    }).join();
    a.print("by another thread's context");
    a.draw(43);
    glFinish();
    std::thread([&] { glXSwapBuffers(display, a.id); }).join();
    a.print("by a thread without a context");
    glXSwapBuffers(display, a.id);
    a.draw(44);
    release();
    glXSwapBuffers(display, a.id);
    a.print("without a context");
    a.bind();
    glXSwapBuffers(display, a.id);
    a.print("with it again");
}

void withOneBuffer(const Drawn& a, const Drawn& b) {
    a.bind();
    a.draw(60);
    b.bind(a.context);
    a.print("one buffer: other window bound");
    b.draw(61);
    b.bind(b.context);
    b.print("one buffer: other context bound");
    b.draw(62);
    release();
    b.print("one buffer: released");
    a.bind();
    a.draw(63);
    b.bind();
    b.draw(64);
    glXSwapBuffers(display, a.id);
    a.print("one buffer: swapped elsewhere");
    glXSwapBuffers(display, b.id);
    b.print("one buffer: swapped");
    release();
}

void entryOf(const Drawn& a) {
    a.bind();
    a.draw(80);
    glXSwapBuffers(display, a.id);
    glDrawBuffer(GL_FRONT);
    a.draw(81);
    release();
    a.print("front, released");
    a.bind();
    glDrawBuffer(GL_BACK);
    release();
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    const Drawn a(choose(True), 0, options.width, options.height),
        b(choose(True), options.width + 20, options.width / 2 + 3, options.height / 2 + 5);
    withOneContext(a, b);
    withTwoContexts(a, b);
    entryOf(a);
    const Drawn c(choose(False), 0, options.width, options.height),
        d(choose(False), options.width + 20, options.width / 2 + 3, options.height / 2 + 5);
    withOneBuffer(c, d);
    return 0;
}
