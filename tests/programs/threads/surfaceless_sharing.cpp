// Contexts without a window that share with a window's context, each in its own thread. One has no drawable (permitted
// by GL 3 and GLX_ARB_create_context), one has only a pbuffer. One thread ends with its context current.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/glx_choice.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <GL/glx.h>
#include <GL/glxext.h>
#include <thread>

using namespace programs;

namespace {

constexpr int kSize = 40;

Display* display;

void use(GLXDrawable drawable, GLXContext context) {
    if (glXMakeContextCurrent(display, drawable, drawable, context) != True) {
        fail("glXMakeContextCurrent failed");
    }
}

GLuint makeTexture() {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    return texture;
}

// Draws with colours that 8 bits represent exactly. The rounding of other colours may depend on a driver's last flush,
// and so on the other thread.
void shapes(unsigned seed) {
    Sequence numbers(seed);
    const auto exact = [&] { return float(numbers.byte()) / 255; };
    fillRectangle(0, 0, kSize, kSize, {exact(), 0.2F, exact()});
    for (int i = 0; i < 8; ++i) {
        fillRectangle(int(numbers.next() % 30), int(numbers.next() % 30), 11, 8, {exact(), exact(), exact()});
    }
}

// Draws into the texture; without a drawable there is no other target. Without `release` the context stays current when
// the thread ends.
void paint(GLXDrawable drawable, GLXContext context, GLuint texture, unsigned seed, bool releases) {
    use(drawable, context);
    if (drawable != None) { // with a copy from the pbuffer
        shapes(seed);
        glBindTexture(GL_TEXTURE_2D, texture);
        glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, kSize, kSize);
    } else {
        GLuint framebuffer = 0;
        glGenFramebuffers(1, &framebuffer);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
        shapes(seed);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDeleteFramebuffers(1, &framebuffer);
    }
    glFinish();
    checkNoError("without a window");
    if (releases) {
        glXMakeContextCurrent(display, None, None, nullptr);
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    const GLXFBConfig config = chooseGlxConfig(display, GLX_WINDOW_BIT | GLX_PBUFFER_BIT);
    XVisualInfo* visual = glXGetVisualFromFBConfig(display, config);
    const XWindow window(*visual, 0, 0, options.width, options.height);
    const int size[] = {GLX_PBUFFER_WIDTH, kSize, GLX_PBUFFER_HEIGHT, kSize, GLX_PRESERVED_CONTENTS, True, None};
    const GLXPbuffer pbuffer = glXCreatePbuffer(display, config, size);
    const GLXContext shown = makeCoreGlxContext(display, config, nullptr),
                     bare = makeCoreGlxContext(display, config, shown),
                     otherContext = makeCoreGlxContext(display, config, bare);
    use(window.id(), shown);
    const GLuint textures[] = {makeTexture(), makeTexture()};
    const GLuint program =
        buildProgram({{GL_VERTEX_SHADER, "#version 330\nuniform float left; out vec2 at;\n"
                                         "void main() { at = vec2(gl_VertexID & 1, gl_VertexID >> 1); gl_Position = "
                                         "vec4(left + at.x * 0.8, at.y * 1.3 - 0.7, 0, 1); }\n"},
                      {GL_FRAGMENT_SHADER, "#version 330\nin vec2 at; uniform sampler2D image; out vec4 result; void "
                                           "main() { result = vec4(texture(image, at).rgb, 1); }\n"}});
    GLuint vertexArray = 0;
    glGenVertexArrays(1, &vertexArray);
    glFinish();
    for (int frame = 0; frame < options.frames; ++frame) {
        glXMakeContextCurrent(display, None, None, nullptr);
        const auto seed = unsigned(frame) * 2;
        std::thread first(paint, None, bare, textures[0], seed, true),
            second(paint, pbuffer, otherContext, textures[1], seed + 1, frame % 2 == 0);
        first.join();
        second.join();
        use(window.id(), shown);
        glViewport(0, 0, options.width, options.height);
        glClearColor(0.2F, 0.3F, 0.1F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        glUseProgram(program);
        glBindVertexArray(vertexArray);
        for (int i = 0; i < 2; ++i) {
            glBindTexture(GL_TEXTURE_2D, textures[i]);
            glUniform1f(glGetUniformLocation(program, "left"), -0.95F + float(i));
            glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        }
        checkNoError("in the window");
        glXSwapBuffers(display, window.id());
    }
    return 0;
}
