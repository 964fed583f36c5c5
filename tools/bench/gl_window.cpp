#include "tools/bench/gl_window.hpp"

#include <cstdio>

namespace mural::bench {

std::unique_ptr<GlWindow> GlWindow::open(int width, int height) {
    std::unique_ptr<GlWindow> opened(new GlWindow);
    opened->display_ = XOpenDisplay(nullptr);
    if (opened->display_ == nullptr) {
        std::fprintf(stderr, "call_cost: no X display; run it through first_light, or under xvfb-run\n");
        return nullptr;
    }
    if (opened->makeWindow(width, height)) return opened;
    std::fprintf(stderr, "call_cost: this display has no OpenGL (GLX); see mural doctor\n");
    return nullptr;
}

bool GlWindow::makeWindow(int width, int height) {
    int wanted[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, GLX_GREEN_SIZE, 8, GLX_BLUE_SIZE, 8, None};
    XVisualInfo* visual = glXChooseVisual(display_, DefaultScreen(display_), wanted);
    if (visual == nullptr) return false;
    const Window root = RootWindow(display_, visual->screen);
    colours_ = XCreateColormap(display_, root, visual->visual, AllocNone);
    XSetWindowAttributes attributes{};
    attributes.colormap = colours_;
    window_ = XCreateWindow(display_, root, 0, 0, static_cast<unsigned>(width), static_cast<unsigned>(height), 0,
                            visual->depth, InputOutput, visual->visual, CWColormap, &attributes);
    XMapWindow(display_, window_);
    context_ = glXCreateContext(display_, visual, nullptr, True);
    XFree(visual);
    return context_ != nullptr && glXMakeCurrent(display_, window_, context_) == True;
}

GlWindow::~GlWindow() {
    if (display_ == nullptr) return;
    glXMakeCurrent(display_, None, nullptr);
    if (context_ != nullptr) glXDestroyContext(display_, context_);
    if (window_ != 0) XDestroyWindow(display_, window_);
    if (colours_ != 0) XFreeColormap(display_, colours_);
    XCloseDisplay(display_);
}

GLuint GlWindow::colourProgram(GLint& location) const {
    const char* vertexSource = "#version 120\nvoid main() { gl_Position = gl_Vertex; }\n";
    const char* fragmentSource = "#version 120\nuniform vec4 colour;\nvoid main() { gl_FragColor = colour; }\n";
    const GLuint program = function<PFNGLCREATEPROGRAMPROC>("glCreateProgram")();
    for (const GLenum stage : {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER}) {
        const GLuint shader = function<PFNGLCREATESHADERPROC>("glCreateShader")(stage);
        const char** source = stage == GL_VERTEX_SHADER ? &vertexSource : &fragmentSource;
        function<PFNGLSHADERSOURCEPROC>("glShaderSource")(shader, 1, source, nullptr);
        function<PFNGLCOMPILESHADERPROC>("glCompileShader")(shader);
        function<PFNGLATTACHSHADERPROC>("glAttachShader")(program, shader);
    }
    function<PFNGLLINKPROGRAMPROC>("glLinkProgram")(program);
    GLint linked = 0;
    function<PFNGLGETPROGRAMIVPROC>("glGetProgramiv")(program, GL_LINK_STATUS, &linked);
    location = function<PFNGLGETUNIFORMLOCATIONPROC>("glGetUniformLocation")(program, "colour");
    if (linked == GL_TRUE && location >= 0) return program;
    std::fprintf(stderr, "call_cost: the GLSL program does not link here; it needs OpenGL 2.1\n");
    return 0;
}

} // namespace mural::bench
