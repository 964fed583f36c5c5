// EGL without windows: a pbuffer, and a second, surfaceless EGL display that renders into a framebuffer object. Both
// pictures are read and shown in a window.
#define EGL_EGLEXT_PROTOTYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 60;

struct Offscreen {
    EGLDisplay display;
    EGLSurface surface;
    EGLContext context;
    GLuint program;

    void makeCurrent() const {
        eglBindAPI(EGL_OPENGL_API);
        if (eglMakeCurrent(display, surface, surface, context) != EGL_TRUE) {
            fail("eglMakeCurrent off screen failed (EGL error 0x%04x)", eglGetError());
        }
    }
};

EGLConfig chooseConfig(EGLDisplay display) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_DEPTH_SIZE,
                             24,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted, &config, 1, &count) != EGL_TRUE || count == 0) {
        fail("no EGL configuration for pbuffers");
    }
    return config;
}

void buildShapes(Offscreen& target) {
    target.makeCurrent();
    target.program = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 330\nuniform float turn; out vec3 tint; void main() { float a = float(gl_VertexID) * 2.3 + turn;\n"
          "tint = vec3(fract(a), fract(a * 0.7), 0.6); gl_Position = vec4(sin(a) * 0.9, cos(a * 1.2) * 0.9, fract(a) - "
          "0.5, 1); }\n"},
         {GL_FRAGMENT_SHADER,
          "#version 330\nin vec3 tint; out vec4 result; void main() { result = vec4(tint, 1); }\n"}});
    GLuint vertexArray = 0;
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
}

Offscreen openPbuffer() {
    Offscreen target = {eglGetDisplay(openDisplayOnce()), EGL_NO_SURFACE, EGL_NO_CONTEXT, 0};
    eglInitialize(target.display, nullptr, nullptr);
    eglBindAPI(EGL_OPENGL_API);
    const EGLConfig config = chooseConfig(target.display);
    const EGLint size[] = {EGL_WIDTH, kSize, EGL_HEIGHT, kSize, EGL_NONE};
    target.surface = eglCreatePbufferSurface(target.display, config, size);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    target.context = eglCreateContext(target.display, config, EGL_NO_CONTEXT, version);
    buildShapes(target);
    return target;
}

Offscreen openSurfaceless() {
    Offscreen target = {eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                        EGL_NO_SURFACE, EGL_NO_CONTEXT, 0};
    if (eglInitialize(target.display, nullptr, nullptr) != EGL_TRUE) {
        fail("no surfaceless EGL");
    }
    eglBindAPI(EGL_OPENGL_API);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    target.context = eglCreateContext(target.display, chooseConfig(target.display), EGL_NO_CONTEXT, version);
    buildShapes(target);
    GLuint names[2];
    glGenRenderbuffers(1, names);
    glBindRenderbuffer(GL_RENDERBUFFER, names[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kSize, kSize);
    glGenFramebuffers(1, names + 1);
    glBindFramebuffer(GL_FRAMEBUFFER, names[1]);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, names[0]);
    return target;
}

std::vector<GLubyte> render(const Offscreen& target, int frame) {
    target.makeCurrent();
    glViewport(0, 0, kSize, kSize);
    glClearColor(0.1F * float(frame), 0.3F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glUseProgram(target.program);
    glUniform1f(glGetUniformLocation(target.program, "turn"),
                float(frame) * 0.5F + (target.surface == EGL_NO_SURFACE ? 1.0F : 0.0F));
    glDrawArrays(GL_TRIANGLES, 0, 12);
    std::vector<GLubyte> pixels(kSize * kSize * 4);
    glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    checkNoError("off screen");
    return pixels;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openEglWindow({}, options.width, options.height);
    const Offscreen pbuffer = openPbuffer();
    const Offscreen surfaceless = openSurfaceless();
    for (int frame = 0; frame < options.frames; ++frame) {
        const auto first = render(pbuffer, frame);
        const auto second = render(surfaceless, frame);
        window->makeCurrent();
        glClearColor(0.15F, 0.1F, 0.15F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        glWindowPos2i(20, 30);
        glDrawPixels(kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, first.data());
        glWindowPos2i(120, 30 + frame);
        glDrawPixels(kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, second.data());
        checkNoError("in the window");
        window->swap();
    }
    return 0;
}
