// An undivided draw, followed by a draw that the nodes divide. Skipping the first must not skip the second.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

GLuint program;
constexpr int kTriangles = 400;

void setUp() {
    program = buildProgram(
        {{GL_VERTEX_SHADER, "#version 120\nuniform float turn; varying vec4 paint; void main() { paint = "
                            "fract(gl_Vertex * 3.7 + turn); gl_Position = gl_Vertex; }"},
         {GL_FRAGMENT_SHADER, "#version 120\nvarying vec4 paint; void main() { gl_FragColor = vec4(paint.xyz, 1); }"}});
    std::vector<float> places{-1, -1, 0.9F, 1, -1, 0.9F, -1, 1, 0.9F, 1, 1, 0.9F}; // the strip, farthest away
    Sequence s(3);
    for (int i = 0; i < kTriangles; ++i) {
        const float x = 2 * s.unit() - 1, y = 2 * s.unit() - 1, z = s.unit() - 0.5F;
        places.insert(places.end(), {x, y, z, x + 0.2F, y, z, x, y + 0.2F, z});
    }
    GLuint buffer;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(places.size() * sizeof(float)), places.data(),
                 GL_STATIC_DRAW);
    glVertexPointer(3, GL_FLOAT, 0, nullptr);
    glEnableClientState(GL_VERTEX_ARRAY);
    glUseProgram(program);
}

void frame(int number) {
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.1F, 0.2F, 0.3F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glUniform1f(glGetUniformLocation(program, "turn"), 0.1F * static_cast<float>(number));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDrawArrays(GL_TRIANGLES, 4, 3 * kTriangles);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) { setUp(); }, [](Window&, int number) { frame(number); });
}
