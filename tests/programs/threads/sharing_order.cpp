// Contexts that share, made current in another order than they were created. The second of a pair uses the objects
// first, the first joins later, and a third joins after the creator of the objects has ended. Toolkits do so: the
// window's context shares with another one that is bound only when its picture is needed.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/glx_choice.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <GL/glx.h>

#include "tests/programs/support/x_window.hpp"

using namespace programs;

namespace {

Display* display;
GLuint program, texture;

void use(const XWindow& window, GLXContext context) {
    if (glXMakeCurrent(display, window.id(), context) != True) {
        fail("glXMakeCurrent failed");
    }
}

void makeShared() {
    program = buildProgram({{GL_VERTEX_SHADER, "#version 330\nuniform vec2 offset; out vec2 at;\n"
                                               "void main() { at = vec2(gl_VertexID & 1, gl_VertexID >> 1); "
                                               "gl_Position = vec4(at * 0.6 + offset, 0, 1); }\n"},
                            {GL_FRAGMENT_SHADER, "#version 330\nin vec2 at; uniform sampler2D image; out vec4 result;\n"
                                                 "void main() { result = vec4(texture(image, at).rgb, 1); }\n"}});
    unsigned char texels[8 * 8 * 4];
    for (int i = 0; i < 8 * 8 * 4; ++i) {
        texels[i] = static_cast<unsigned char>(i * 37);
    }
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 8, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
}

void draw(float x, float y) {
    GLuint array = 0; // vertex arrays are not shared: each context has its own
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glUseProgram(program);
    glBindTexture(GL_TEXTURE_2D, texture);
    glUniform2f(glGetUniformLocation(program, "offset"), x, y);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDeleteVertexArrays(1, &array);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    const GLXFBConfig config = chooseGlxConfig(display, GLX_WINDOW_BIT);
    XVisualInfo* visual = glXGetVisualFromFBConfig(display, config);
    const XWindow window(*visual, 0, 0, options.width, options.height);
    const GLXContext named = makeCoreGlxContext(display, config, nullptr); // not current before the others
    const GLXContext maker = makeCoreGlxContext(display, config, named);
    const GLXContext last = makeCoreGlxContext(display, config, maker);
    use(window, maker);
    makeShared();
    for (int frame = 0; frame < options.frames; ++frame) {
        use(window, frame == 0 ? maker : last);
        glClearColor(0.2F, 0.1F * float(frame), 0.4F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        draw(-0.9F, -0.8F + 0.1F * float(frame));
        checkNoError("in the later contexts");
        if (frame > 0) {
            use(window, named);
            draw(0.1F, -0.2F);
            checkNoError("in the first context");
        }
        glXSwapBuffers(display, window.id());
        if (frame == 0) { // the context that holds the objects ends before the other two have been current
            glXMakeCurrent(display, None, nullptr);
            glXDestroyContext(display, maker);
        }
    }
    return 0;
}
