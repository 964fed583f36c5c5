// Binds contexts of several configurations to plain X windows, so that GLX creates the windows' drawables again. A
// helper context without depth comes first, and contexts release their windows. A display is closed with all its
// objects, and the next connection receives the same numbers. Depth tests make a wrong configuration visible.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <GL/glx.h>
#include <X11/Xutil.h>

using namespace programs;

namespace {

struct Choice {
    GLXFBConfig config;
    XVisualInfo* visual;
};

int attribute(Display* display, GLXFBConfig config, int name) {
    int value = 0;
    glXGetFBConfigAttrib(display, config, name, &value);
    return value;
}

// Chooses a configuration with that visual, or with any (0).
Choice choose(Display* display, bool depth, VisualID wanted = 0) {
    int count = 0;
    GLXFBConfig* all = glXGetFBConfigs(display, DefaultScreen(display), &count);
    for (int i = 0; i < count; ++i) {
        const auto has = [&](int name) { return attribute(display, all[i], name); };
        if (!(has(GLX_DRAWABLE_TYPE) & GLX_WINDOW_BIT) || !has(GLX_DOUBLEBUFFER) || has(GLX_RED_SIZE) != 8 ||
            has(GLX_SAMPLES) || has(GLX_ACCUM_RED_SIZE))
            continue;
        if ((has(GLX_DEPTH_SIZE) > 0) != depth) continue;
        XVisualInfo* visual = glXGetVisualFromFBConfig(display, all[i]);
        if (visual && visual->depth == 24 && (wanted == 0 || visual->visualid == wanted)) return {all[i], visual};
    }
    return {nullptr, nullptr};
}

struct Connection {
    Display* display = XOpenDisplay(nullptr);
    Choice deep{}, flat{};

    Connection() {
        if (!display) fail("no X display");
        deep = choose(display, true);
        flat = choose(display, false);
        if (!deep.config || !flat.config) fail("no configurations with and without depth");
    }
    [[nodiscard]] ::Window window(int width, int height) const {
        const ::Window root = DefaultRootWindow(display);
        XSetWindowAttributes attributes = {};
        attributes.colormap = XCreateColormap(display, root, deep.visual->visual, AllocNone);
        const ::Window made = XCreateWindow(display, root, 0, 0, static_cast<unsigned>(width),
                                            static_cast<unsigned>(height), 0, deep.visual->depth, InputOutput,
                                            deep.visual->visual, CWColormap | CWBorderPixel, &attributes);
        XMapWindow(display, made);
        XSync(display, False);
        return made;
    }
    [[nodiscard]] GLXContext context(const Choice& choice) const {
        GLXContext made = glXCreateNewContext(display, choice.config, GLX_RGBA_TYPE, nullptr, True);
        if (!made) fail("no context");
        return made;
    }
    void bind(::Window window, GLXContext context) const {
        if (!glXMakeCurrent(display, window, context)) fail("a context can't be made current");
    }
};

// Draws near shapes first: without a depth test the far ones cover them.
void drawFrame(int frame, int which) {
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.1F * float(which), 0.2F, 0.3F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (int i = 0; i < 6; ++i) {
        const float z = 0.8F - 0.3F * float((i + frame) % 6), at = 0.1F * float(i) - 0.5F;
        glColor3f(float(i) / 6, float(which) / 8, 1 - float(i) / 6);
        glBegin(GL_TRIANGLES);
        glVertex3f(at - 0.4F, at - 0.4F, z);
        glVertex3f(at + 0.7F, at - 0.2F, -z);
        glVertex3f(at, at + 0.6F, z);
        glEnd();
    }
    glDisable(GL_DEPTH_TEST);
    GLint depth = 0;
    glGetIntegerv(GL_DEPTH_BITS, &depth);
    showBits(1, std::uint32_t(depth));
    showBits(2, std::uint32_t(frame * 8 + which));
    checkNoError("in a frame");
}

void showFrames(const Connection& on, ::Window window, GLXContext context, int frames, int which) {
    on.bind(window, context);
    for (int frame = 0; frame < frames; ++frame) {
        drawFrame(frame, which);
        glXSwapBuffers(on.display, window);
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const int frames = options.frames;
    ::Window first = 0;
    {
        const Connection on;
        const ::Window window = first = on.window(options.width, options.height);
        const GLXContext helper = on.context(on.flat), real = on.context(on.deep);
        showFrames(on, window, helper, 1, 1);
        showFrames(on, window, real, frames, 2); // the helper keeps the window bound: no depth
        on.bind(None, nullptr);
        glXDestroyContext(on.display, helper);
        showFrames(on, window, real, 1, 3); // now the real context keeps it bound
        const ::Window other = on.window(options.width / 2, options.height / 2);
        showFrames(on, other, real, 1, 4);
        showFrames(on, window, real, frames, 5); // it was released: with depth from now on
        const GLXContext late = on.context(on.flat);
        showFrames(on, window, late, 1, 6); // kept bound with depth
        XCloseDisplay(on.display);          // with all its objects
        if (glXGetCurrentContext()) fail("a context of a closed display is current");
    }
    const Connection again;
    const ::Window window = again.window(options.width, options.height);
    if (window != first) fail("the server gives other numbers than to the first connection");
    // no depth: nothing of the first connection remains
    showFrames(again, window, again.context(again.flat), frames, 7);
    XDestroyWindow(again.display, window);
    showFrames(again, again.window(options.width, options.height), again.context(again.deep), 1, 8);
    return 0;
}
