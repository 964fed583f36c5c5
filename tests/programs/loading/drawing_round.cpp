#include "tests/programs/loading/drawing_round.hpp"

#include <EGL/egl.h>
#include <GL/gl.h>
#include <GL/glx.h>
#include <X11/Xutil.h>
#include <cstdint>
#include <cstdio>
#include <dlfcn.h>
#include <vector>

#include "tests/programs/support/program.hpp"

namespace programs {

namespace {

class Library {
public:
    explicit Library(const char* name) : handle_(dlopen(name, RTLD_LAZY | RTLD_LOCAL)) {
        if (handle_ == nullptr) fail("%s", dlerror());
    }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
    ~Library() { dlclose(handle_); }

    template <class F> F function(const char* name) const {
        auto found = reinterpret_cast<F>(dlsym(handle_, name));
        if (found == nullptr) fail("no %s", name);
        return found;
    }

private:
    void* handle_;
};
// Finds a function by name. Only the type comes from the headers: the program links no GL library.
#define FUNCTION(library, name) (library).function<decltype(&::name)>(#name)

// Draws with scissored clears; all sizes are the window's.
struct Painter {
    decltype(&::glClearColor) clearColor;
    decltype(&::glClear) clear;
    decltype(&::glScissor) scissor;
    decltype(&::glEnable) enable;
    decltype(&::glDisable) disable;
    decltype(&::glReadPixels) readPixels;

    explicit Painter(const Library& gl)
        : clearColor(FUNCTION(gl, glClearColor)),
          clear(FUNCTION(gl, glClear)),
          scissor(FUNCTION(gl, glScissor)),
          enable(FUNCTION(gl, glEnable)),
          disable(FUNCTION(gl, glDisable)),
          readPixels(FUNCTION(gl, glReadPixels)) {}

    void draw(int round, int frame, int width, int height) const {
        clearColor(0.2F * float(round % 5), 0.3F * float(frame % 3), 1, 1);
        clear(GL_COLOR_BUFFER_BIT);
        enable(GL_SCISSOR_TEST);
        scissor(width / 3, height / 4, width / 2, height / 3);
        clearColor(1, 0.2F * float(round % 5), 0.1F * float(frame), 1);
        clear(GL_COLOR_BUFFER_BIT);
        disable(GL_SCISSOR_TEST);
    }
};

uint64_t sumOf(const void* bytes, size_t count) {
    uint64_t sum = 1469598103934665603U;
    for (size_t i = 0; i < count; ++i) sum = (sum ^ static_cast<const uint8_t*>(bytes)[i]) * 1099511628211U;
    return sum;
}

// A window on a connection of its own, closed at the end.
class OwnWindow {
public:
    OwnWindow(Display* display, const XVisualInfo& visual, int width, int height)
        : display_(display), width_(width), height_(height) {
        XSetWindowAttributes attributes{};
        attributes.colormap = XCreateColormap(display, DefaultRootWindow(display), visual.visual, AllocNone);
        attributes.override_redirect = True;
        id_ =
            XCreateWindow(display, DefaultRootWindow(display), 0, 0, unsigned(width), unsigned(height), 0, visual.depth,
                          InputOutput, visual.visual, CWBorderPixel | CWColormap | CWOverrideRedirect, &attributes);
        XMapWindow(display, id_);
        XSync(display, False);
    }
    OwnWindow(const OwnWindow&) = delete;
    OwnWindow& operator=(const OwnWindow&) = delete;
    ~OwnWindow() { XDestroyWindow(display_, id_); }

    [[nodiscard]] ::Window id() const { return id_; }
    void printPixels(const char* where, int round, int frame, const Painter& gl) const {
        std::vector<uint8_t> pixels(size_t(width_) * size_t(height_) * 4);
        gl.readPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        std::printf("%s round %d frame %d: %016llx\n", where, round, frame,
                    static_cast<unsigned long long>(sumOf(pixels.data(), pixels.size())));
    }
    void printWindow(int round) const {
        XImage* image = XGetImage(display_, id_, 0, 0, unsigned(width_), unsigned(height_), AllPlanes, ZPixmap);
        if (image == nullptr) fail("no image");
        uint64_t sum = 0;
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) sum = sum * 31 + (XGetPixel(image, x, y) & 0xffffff);
        XDestroyImage(image);
        std::printf("window of round %d: %016llx\n", round, static_cast<unsigned long long>(sum));
    }

private:
    Display* display_;
    ::Window id_ = 0;
    int width_, height_;
};

void drawByGlx(const Round& round, Display* display, int width, int height) {
    const Library library("libGL.so.1");
    const auto chooseVisual = FUNCTION(library, glXChooseVisual);
    const auto createContext = FUNCTION(library, glXCreateContext);
    const auto makeCurrent = FUNCTION(library, glXMakeCurrent);
    const auto swapBuffers = FUNCTION(library, glXSwapBuffers);
    const auto destroyContext = FUNCTION(library, glXDestroyContext);
    int attributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, GLX_DEPTH_SIZE, 24, None};
    XVisualInfo* visual = chooseVisual(display, DefaultScreen(display), attributes);
    if (visual == nullptr) fail("round %d: no visual", round.number);
    {
        const OwnWindow window(display, *visual, width, height);
        const GLXContext context = createContext(display, visual, nullptr, True);
        if (makeCurrent(display, window.id(), context) != True) fail("round %d: glXMakeCurrent", round.number);
        const Painter gl(library);
        for (int frame = 0; frame < round.frames; ++frame) {
            gl.draw(round.number, frame, width, height);
            window.printPixels("glx", round.number, frame, gl);
            swapBuffers(display, window.id());
        }
        window.printWindow(round.number);
        makeCurrent(display, None, nullptr);
        destroyContext(display, context);
    }
    XFree(visual);
    XCloseDisplay(display);
}

XVisualInfo visualOf(Display* display, VisualID id) {
    XVisualInfo wanted{};
    wanted.visualid = id;
    int count = 0;
    XVisualInfo* found = XGetVisualInfo(display, VisualIDMask, &wanted, &count);
    if (found == nullptr) fail("no visual");
    const XVisualInfo visual = *found;
    XFree(found);
    return visual;
}

void drawByEgl(const Round& round, Display* display, int width, int height) {
    const Library egl("libEGL.so.1"), gles("libGLESv2.so.2");
    const auto terminate = FUNCTION(egl, eglTerminate);
    const auto makeCurrent = FUNCTION(egl, eglMakeCurrent);
    const auto swapBuffers = FUNCTION(egl, eglSwapBuffers);
    const EGLDisplay connection = FUNCTION(egl, eglGetDisplay)(reinterpret_cast<EGLNativeDisplayType>(display));
    if (FUNCTION(egl, eglInitialize)(connection, nullptr, nullptr) != EGL_TRUE) fail("round %d: no EGL", round.number);
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES2_BIT, EGL_RED_SIZE, 8,
                             EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0, visual = 0;
    if (FUNCTION(egl, eglChooseConfig)(connection, wanted, &config, 1, &count) != EGL_TRUE || count == 0)
        fail("round %d: no configuration", round.number);
    FUNCTION(egl, eglGetConfigAttrib)(connection, config, EGL_NATIVE_VISUAL_ID, &visual);
    {
        const OwnWindow window(display, visualOf(display, VisualID(visual)), width, height);
        const EGLSurface surface = FUNCTION(egl, eglCreateWindowSurface)(connection, config, window.id(), nullptr);
        const EGLContext context = FUNCTION(egl, eglCreateContext)(connection, config, EGL_NO_CONTEXT, version);
        if (makeCurrent(connection, surface, surface, context) != EGL_TRUE)
            fail("round %d: eglMakeCurrent", round.number);
        const Painter gl(gles);
        for (int frame = 0; frame < round.frames; ++frame) {
            gl.draw(round.number, frame, width, height);
            window.printPixels("egl", round.number, frame, gl);
            swapBuffers(connection, surface);
        }
        window.printWindow(round.number);
        makeCurrent(connection, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        FUNCTION(egl, eglDestroyContext)(connection, context);
        FUNCTION(egl, eglDestroySurface)(connection, surface);
        terminate(connection);
    }
    XCloseDisplay(display);
}

} // namespace

void drawRound(const Round& round) {
    Display* display = XOpenDisplay(round.display.c_str());
    if (display == nullptr) fail("no display %s", round.display.c_str());
    const int width = 140 + 30 * (round.number % 4), height = 100;
    if (round.system == WindowSystem::Glx)
        drawByGlx(round, display, width, height);
    else
        drawByEgl(round, display, width, height);
    std::fflush(stdout);
}

} // namespace programs
