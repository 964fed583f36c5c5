// Redundant state changes, in another order each time, as from a program that sets all state of an object without
// regard to others. Most state is set already, some is restored before the next draw, and two programs receive
// uniforms, one of which draws rarely. The state that a draw needs must be set nevertheless: it is visible in blending,
// masks, culling, scissors and colours.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <functional>
#include <utility>
#include <vector>

using namespace programs;

namespace {

constexpr int kObjects = 48, kColumns = 8, kSeldom = 20; // period of a rare draw, in frames
GLuint often = 0, seldom = 0;

struct Uniforms {
    GLint offset, color, gain, strip;
};
Uniforms ofOften, ofSeldom;

Uniforms uniformsOf(GLuint program) {
    return {glGetUniformLocation(program, "offset"), glGetUniformLocation(program, "color"),
            glGetUniformLocation(program, "gain"), glGetUniformLocation(program, "strip")};
}

void setUp(Window&) {
    const char* const vertex = "#version 120\n"
                               "uniform vec2 offset;\n"
                               "void main() { gl_Position = vec4(gl_Vertex.xy * 0.15 + offset, gl_Vertex.z, 1.0); }\n";
    const char* const fragment =
        "#version 120\n"
        "uniform vec4 color; uniform float gain; uniform int strip;\n"
        "void main() { gl_FragColor = color * gain + vec4(float(strip) * 0.1, 0.0, 0.0, 0.0); }\n";
    often = buildProgram({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
    seldom = buildProgram({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
    ofOften = uniformsOf(often);
    ofSeldom = uniformsOf(seldom);
}

// Sets all state of an object, in a random order. There are few kinds of objects, so most state does not change.
void setAll(unsigned kind, Sequence& numbers, int width, int height) {
    const bool third = kind % 3 == 0;
    std::vector<std::function<void()>> sets{
        [&] { third ? glEnable(GL_BLEND) : glDisable(GL_BLEND); },
        [&] { glBlendFunc(GL_SRC_ALPHA, third ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA); },
        [&] { glBlendEquation(GL_FUNC_ADD); },
        [&] { glEnable(GL_DEPTH_TEST); },
        [&] { glDepthFunc(kind == 5 ? GL_ALWAYS : GL_LEQUAL); },
        [&] { glDepthMask(kind == 5 ? GL_FALSE : GL_TRUE); },
        [&] { glColorMask(GL_TRUE, kind == 4 ? GL_FALSE : GL_TRUE, GL_TRUE, GL_TRUE); },
        [&] { kind == 2 ? glEnable(GL_CULL_FACE) : glDisable(GL_CULL_FACE); },
        [&] { glCullFace(kind == 2 ? GL_BACK : GL_FRONT); },
        [&] { glFrontFace(GL_CCW); },
        [&] { kind == 1 ? glEnable(GL_SCISSOR_TEST) : glDisable(GL_SCISSOR_TEST); },
        [&] { glScissor(0, 0, width * 3 / 4, height * 3 / 4); },
        [&] { glViewport(0, 0, width, height); },
        [&] { glPolygonMode(GL_FRONT_AND_BACK, GL_FILL); },
        [&] { glPolygonOffset(0, 0); },
        [&] { glDisable(GL_STENCIL_TEST); },
        [&] { glStencilFunc(GL_ALWAYS, 0, 0xff); },
        [&] { glLineWidth(1); },
        [&] { glShadeModel(GL_SMOOTH); },
    };
    for (size_t left = sets.size(); left > 0; --left) {
        const size_t which = numbers.next() % left;
        sets[which]();
        std::swap(sets[which], sets[left - 1]);
    }
}

void draw(Window& window, int frame) {
    Sequence numbers(77 + unsigned(frame));
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDisable(GL_SCISSOR_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (int i = 0; i < kObjects; ++i) {
        const unsigned kind = numbers.next() % 6;
        setAll(numbers.next() % 6, numbers, window.width(), window.height()); // state of an invisible object
        setAll(kind, numbers, window.width(), window.height());
        for (const bool isOften : {false, true}) {
            const Uniforms& u = isOften ? ofOften : ofSeldom;
            glUseProgram(isOften ? often : seldom);
            glUniform1f(u.gain, kind == 3 ? 0.5F : 1.0F);
            glUniform1i(u.strip, int(kind));
            glUniform4f(u.color, 0.2F, float(kind) / 6, isOften ? 0.9F : 0.1F, 0.6F);
            glUniform2f(u.offset, float(i % kColumns) * 0.24F - 0.85F,
                        float(i / kColumns) * 0.3F - 0.8F); // NOLINT(bugprone-integer-division)
        }
        if (frame % kSeldom == kSeldom - 1 && i % 7 == 0) glUseProgram(seldom);
        const GLfloat z = float(kind) * 0.1F;
        glBegin(GL_TRIANGLE_FAN);
        glVertex3f(-1, -1, z), glVertex3f(1, -1, z), glVertex3f(1, 1, 0), glVertex3f(-1, 1, -z);
        glEnd();
    }
    glUseProgram(0);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
