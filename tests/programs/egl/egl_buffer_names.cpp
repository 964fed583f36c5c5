// Saves, sets and restores the buffers for reading and drawing, as libraries do, on all kinds of EGL surfaces. Pbuffers
// and pixmaps have one buffer and windows have two, for any EGL_RENDER_BUFFER.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

using namespace programs;

namespace {

enum class Kind { Window, SingleWindow, Pbuffer, Pixmap };

struct Surface {
    EGLSurface surface = EGL_NO_SURFACE;
    EGLContext context = EGL_NO_CONTEXT;
    bool desktop = true;
};

EGLConfig choose(EGLDisplay display, EGLint surfaces, EGLint api) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, surfaces, EGL_RENDERABLE_TYPE, api, EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8,
                             EGL_BLUE_SIZE,    8,        EGL_DEPTH_SIZE,      24,  EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE || count == 0) fail("no EGL configuration");
    return config;
}

EGLSurface makeSurface(EGLDisplay display, EGLConfig config, Kind kind, int width, int height) {
    Display* x = openDisplayOnce();
    const ::Window root = DefaultRootWindow(x);
    const EGLint single[] = {EGL_RENDER_BUFFER, EGL_SINGLE_BUFFER, EGL_NONE},
                 size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    const auto w = static_cast<unsigned>(width), h = static_cast<unsigned>(height);
    if (kind == Kind::Pbuffer) return eglCreatePbufferSurface(display, config, size);
    if (kind == Kind::Pixmap) {
        const Pixmap pixmap = XCreatePixmap(x, root, w, h, static_cast<unsigned>(DefaultDepth(x, DefaultScreen(x))));
        XSync(x, False);
        return eglCreatePixmapSurface(display, config, pixmap, nullptr);
    }
    const ::Window window = XCreateSimpleWindow(x, root, 0, 0, w, h, 0, 0, 0);
    XMapWindow(x, window);
    XSync(x, False);
    return eglCreateWindowSurface(display, config, window, kind == Kind::SingleWindow ? single : nullptr);
}

Surface make(EGLDisplay display, Kind kind, bool desktop, const Options& options) {
    const EGLint surfaces = kind == Kind::Pbuffer  ? EGL_PBUFFER_BIT
                            : kind == Kind::Pixmap ? EGL_PIXMAP_BIT
                                                   : EGL_WINDOW_BIT;
    EGLConfig config = choose(display, surfaces, desktop ? EGL_OPENGL_BIT : EGL_OPENGL_ES3_BIT);
    eglBindAPI(desktop ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
    const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE};
    Surface made;
    made.desktop = desktop;
    made.surface = makeSurface(display, config, kind, options.width, options.height);
    made.context = eglCreateContext(display, config, EGL_NO_CONTEXT, desktop ? nullptr : version);
    if (!made.surface || !made.context) fail("no drawable or context (EGL error 0x%04x)", eglGetError());
    return made;
}

GLint value(GLenum name) {
    GLint found = 0;
    glGetIntegerv(name, &found);
    return found;
}

// Shows the colour of a pixel in the buffer `name`, which stays selected for reading.
void showRead(int row, GLint name) {
    GLubyte pixel[4] = {};
    glReadBuffer(GLenum(name));
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    showBits(row, std::uint32_t(pixel[0]) << 16 | std::uint32_t(pixel[1]) << 8 | pixel[2]);
}

void drawFrame(const Surface& d, bool one, int frame) {
    const GLint reads = value(GL_READ_BUFFER), draws = value(d.desktop ? GL_DRAW_BUFFER : GL_DRAW_BUFFER0);
    glClearColor(0.1F * float(frame + 1), one ? 0.8F : 0.2F, 0.5F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    showBits(1, std::uint32_t(reads) << 16 | std::uint32_t(draws));
    if (d.desktop) showBits(2, std::uint32_t(value(GL_DOUBLEBUFFER)));
    showRead(3, reads);   // the saved buffer
    showRead(4, GL_BACK); // the drawn buffer
    if (d.desktop && one) showRead(5, GL_FRONT);
    if (d.desktop && one) { // drawn through its other name, and through both
        glDrawBuffer(GL_FRONT);
        fillRectangle(0, 60, 40, 20, {1, 0, 0});
        glDrawBuffer(GL_BACK);
        fillRectangle(20, 70, 40, 20, {0, 0, 1});
        glDrawBuffer(GLenum(draws));
    }
    glReadBuffer(GLenum(reads));
    checkNoError("in a frame");
}

void showAll(EGLDisplay display, const Surface& d, bool one, int frames) {
    eglBindAPI(d.desktop ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
    if (eglMakeCurrent(display, d.surface, d.surface, d.context) != EGL_TRUE)
        fail("eglMakeCurrent failed (EGL error 0x%04x)", eglGetError());
    for (int frame = 0; frame < frames; ++frame) {
        drawFrame(d, one, frame);
        glFlush(); // has no visible effect
        eglSwapBuffers(display, d.surface);
        if (one) showRead(6, value(GL_READ_BUFFER)); // a swap does not change it
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    EGLDisplay display = eglGetDisplay(openDisplayOnce());
    if (!display || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) fail("no EGL display");
    for (const bool desktop : {true, false})
        for (const Kind kind : {Kind::Window, Kind::SingleWindow, Kind::Pbuffer, Kind::Pixmap})
            showAll(display, make(display, kind, desktop, options), kind == Kind::Pbuffer || kind == Kind::Pixmap,
                    options.frames);
    // Ends surfaces while they are current, together with their display. Later surfaces are new ones.
    eglTerminate(display);
    eglReleaseThread();
    eglInitialize(display, nullptr, nullptr);
    const Surface last = make(display, Kind::Pbuffer, true, options);
    eglMakeCurrent(display, last.surface, last.surface, last.context);
    eglDestroySurface(display, last.surface);
    glClearColor(0.3F, 0.6F, 0.9F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    GLubyte pixel[4] = {};
    glReadPixels(1, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    if (pixel[1] != 153) fail("a destroyed surface that is current is not drawn into");
    if (eglSwapBuffers(display, last.surface) == EGL_TRUE) fail("a destroyed surface is swapped");
    showAll(display, make(display, Kind::Window, true, options), false, options.frames);
    return 0;
}
