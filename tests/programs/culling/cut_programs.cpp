// Vertex shaders of many kinds, whose draws nodes may leave out or cut: matrix chains, conditions, loops, attributes of
// other types, sizes of points. Others must stay whole: displacements, primitive numbers, instances with attributes of
// their own, texts that ask for the driver's extensions.
#include <array>
#include <cmath>
#include <string>

#include "tests/programs/culling/meshes.hpp"
#include "tests/programs/support/matrix.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

const char* const kVertexTexts[] = {
    "#version 120\nattribute vec3 place; attribute vec4 tint; uniform mat4 view, model; varying vec4 shade;\n"
    "void main() { shade = tint; gl_Position = view * model * vec4(place, 1.0); }",
    "#version 120\nattribute vec3 place; attribute vec4 tint; uniform mat4 view, model; varying vec4 shade;\n"
    "vec4 moved(in mat4 m, vec3 p) { return m * vec4(p, 1.0); }\n"
    "void main() { shade = tint; vec4 world = moved(model, place); gl_Position = (view * world); }",
    "#version 330\nin vec3 place; in vec4 tint; uniform mat4 view, model; out vec4 shade;\n"
    "uniform struct Step { vec3 by[2]; bool used; } steps[2];\n"
    "void main() { shade = tint; vec3 p = place;\n"
    "  for (int i = 0; i < 2; ++i) if (steps[i].used) p += steps[i].by[1];\n"
    "  gl_Position = view * model * vec4(p, 1.0); }",
    "#version 330\nin vec3 place; in vec4 tint; uniform mat4 view, model; out vec4 shade;\n"
    "void main() { shade = tint; gl_Position = view * model * vec4(place.xy, place.z + 0.3 * sin(9.0 * place.x), 1.0); "
    "}",
    "#version 330\nin vec3 place; in vec4 tint; uniform mat4 view, model; out vec4 shade;\n"
    "void main() { shade = tint; gl_PointSize = 2.0 + 9.0 * tint.r; gl_Position = view * model * vec4(place, 1.0); }",
    "#version 330\n#ifdef GL_ARB_gpu_shader5\n#define SCALE 1.1\n#else\n#define SCALE 0.5\n#endif\n"
    "in vec3 place; in vec4 tint; uniform mat4 view, model; out vec4 shade;\n"
    "void main() { shade = tint; gl_Position = view * model * vec4(place * SCALE, 1.0); }",
    "#version 330\nin vec3 place; in vec4 tint; uniform mat4 view, model; out vec4 shade; in vec2 shift;\n"
    "void main() { shade = tint; gl_Position = view * model * vec4(place.xy * 0.2 + shift, place.z, 1.0); }",
    "#version 330\nin vec3 place; in vec4 tint; uniform mat4 view, model; out vec4 shade;\n"
    "void main() { shade = vec4(fract(float(gl_VertexID) * 0.013), tint.gb, 1.0);\n"
    "  gl_Position = view * model * vec4(place, 1.0); }",
};
constexpr int kPrograms = static_cast<int>(std::size(kVertexTexts));
constexpr int kInstanced = 6, kSized = 4, kStepped = 2;

GLuint programs_[kPrograms], numbered;
GLuint mesh, shorts, shifts, arrays[3];
GLsizei vertices;

GLuint linked(const char* vertexText, const char* colour, const char* version) {
    const std::string head = std::string(version) + (std::string(version) == "#version 120\n" ? "varying" : "in") +
                             " vec4 shade; void main() { gl_FragColor = " + colour + "; }";
    return buildProgram({{GL_VERTEX_SHADER, vertexText}, {GL_FRAGMENT_SHADER, head.c_str()}}, [](unsigned program) {
        glBindAttribLocation(program, 0, "place");
        glBindAttribLocation(program, 1, "tint");
        glBindAttribLocation(program, 2, "shift");
    });
}

void setUp(Window&) {
    for (int i = 0; i < kPrograms; ++i)
        programs_[i] = linked(kVertexTexts[i], "shade", i < 2 ? "#version 120\n" : "#version 150 compatibility\n");
    numbered = linked(kVertexTexts[2], "vec4(fract(float(gl_PrimitiveID) * 0.037), shade.rg, 1.0)",
                      "#version 150 compatibility\n");
    const std::vector<Vertex> cells = field(30, 30, 6);
    vertices = static_cast<GLsizei>(cells.size());
    mesh = bufferOf(GL_ARRAY_BUFFER, cells.size() * sizeof(Vertex), cells.data());
    std::vector<std::array<GLshort, 4>> small;
    for (const Vertex& v : cells)
        small.push_back({static_cast<GLshort>(v.x * 32767), static_cast<GLshort>(v.y * 32767),
                         static_cast<GLshort>(v.z * 32767), 0});
    shorts = bufferOf(GL_ARRAY_BUFFER, small.size() * 8, small.data());
    const std::array<float, 8> places{-0.7F, -0.7F, 0.7F, -0.6F, -0.6F, 0.7F, 0.6F, 0.5F};
    shifts = bufferOf(GL_ARRAY_BUFFER, sizeof places, places.data());
    glGenVertexArrays(3, arrays);
    for (int i = 0; i < 3; ++i) {
        glBindVertexArray(arrays[i]);
        glBindBuffer(GL_ARRAY_BUFFER, mesh);
        glEnableVertexAttribArray(0);
        glEnableVertexAttribArray(1);
        glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Vertex), offsetOf(12));
        if (i == 0) glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offsetOf(0));
        if (i == 1) { // the format apart from the buffer
            glVertexAttribFormat(0, 3, GL_FLOAT, GL_FALSE, 0);
            glVertexAttribBinding(0, 3);
            glBindVertexBuffer(3, mesh, 0, sizeof(Vertex));
        }
        if (i == 2) {
            glBindBuffer(GL_ARRAY_BUFFER, shorts);
            glVertexAttribPointer(0, 3, GL_SHORT, GL_TRUE, 8, offsetOf(0));
        }
    }
    glBindVertexArray(0);
}

void setUniforms(GLuint program, const Matrix& view, const Matrix& model, int frame) {
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "view"), 1, GL_FALSE, view.data());
    glUniformMatrix4fv(glGetUniformLocation(program, "model"), 1, GL_FALSE, model.data());
    const GLint by = glGetUniformLocation(program, "steps[0].by[1]");
    if (by < 0) return;
    glUniform3f(by, 0.3F, -0.2F, 0.1F);
    glUniform1i(glGetUniformLocation(program, "steps[0].used"), frame % 2);
}

void draw(Window&, int frame) {
    glClearColor(0.2F, 0.1F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    const Matrix view = multiply(perspective(0.2F, 0.2F, 0.2F, 40), translation(0, 0, -2.2F));
    for (int i = 0; i < kPrograms; ++i) {
        const auto turn = 0.1F * static_cast<float>(frame + 5 * i);
        const Matrix model = multiply(multiply(translation(0.7F * std::sin(2.1F * static_cast<float>(i)),
                                                           0.6F * std::cos(1.7F * static_cast<float>(i)), 0.2F),
                                               rotationY(turn)),
                                      scaling(1.1F, 1.1F, 1.1F));
        setUniforms(programs_[i], view, model, frame);
        glBindVertexArray(arrays[i % 3]);
        if (i == kInstanced) {
            glBindBuffer(GL_ARRAY_BUFFER, shifts);
            glEnableVertexAttribArray(2);
            glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, 8, offsetOf(0));
            glVertexAttribDivisor(2, 1);
            glDrawArraysInstanced(GL_TRIANGLES, 0, vertices, 4);
            glDisableVertexAttribArray(2);
            continue;
        }
        if (i == kSized) glEnable(GL_PROGRAM_POINT_SIZE);
        glDrawArrays(i == kSized ? GL_POINTS : GL_TRIANGLES, 0, vertices);
        glDisable(GL_PROGRAM_POINT_SIZE);
        for (GLint first = 0; first < vertices; first += 600) glDrawArrays(GL_TRIANGLES, first, 90);
        if (i == 0) glDrawArraysInstanced(GL_TRIANGLES, 0, vertices / 2, 3);
    }
    setUniforms(numbered, view, multiply(translation(0.8F, -0.4F, 0), rotationY(0.3F * static_cast<float>(frame))),
                frame);
    glBindVertexArray(arrays[0]);
    glDrawArrays(GL_TRIANGLES, 0, vertices);
    glBindVertexArray(0);
    glUseProgram(0);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, WindowSpec{}, setUp, draw); }
