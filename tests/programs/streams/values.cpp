// Passes a large value with a call, a random one of a few in each frame. MURAL_VALUE selects it:
//   0  the source of a shader that is created again
//   1  vertices in the program's memory
//   2  an image for glDrawPixels
#define GL_GLEXT_PROTOTYPES 1
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

using namespace programs;

namespace {

constexpr size_t kValues = 3;
constexpr int kTriangles = 1500, kSide = 96;
std::array<std::string, kValues> sources;
std::array<std::vector<GLfloat>, kValues> vertices;
std::array<std::vector<std::uint32_t>, kValues> images;

void setUp(Window&) {
    Sequence numbers(5);
    for (size_t i = 0; i < kValues; ++i) {
        sources[i] = "void main() { vec4 c = vec4(0.5);\n";
        while (sources[i].size() < 16000)
            sources[i] += "c = c * 0.75 + vec4(" + std::to_string(numbers.unit()) + ", " +
                          std::to_string(numbers.unit()) + ", 0.25, 0.5);\n";
        sources[i] += "gl_FragColor = c; }\n";
        for (int n = 0; n < kTriangles * 6; ++n) vertices[i].push_back(numbers.unit() * 2 - 1);
        for (int n = 0; n < kSide * kSide; ++n) images[i].push_back(numbers.next() * 257U);
    }
}

void draw(Window&, int frame) {
    const size_t which = Sequence(std::uint32_t(frame) * 7919U + 1U).next() % kValues;
    glClear(GL_COLOR_BUFFER_BIT);
    switch (MURAL_VALUE) {
    case 0: {
        const GLuint program = buildProgram({{GL_VERTEX_SHADER, "void main() { gl_Position = gl_Vertex; }"},
                                             {GL_FRAGMENT_SHADER, sources[which].c_str()}});
        glUseProgram(program);
        glRectf(-0.8F, -0.8F, 0.8F, 0.8F);
        glUseProgram(0);
        glDeleteProgram(program);
        break;
    }
    case 1:
        glEnableClientState(GL_VERTEX_ARRAY);
        glVertexPointer(2, GL_FLOAT, 0, vertices[which].data());
        glDrawArrays(GL_TRIANGLES, 0, kTriangles * 3);
        break;
    default: glRasterPos2f(-0.9F, -0.9F); glDrawPixels(kSide, kSide, GL_RGBA, GL_UNSIGNED_BYTE, images[which].data());
    }
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
