// Much geometry in small pieces, from every stage that can be the last before the rasteriser. Dropping geometry outside
// a tile saves much time here and must not change a pixel. Triangle soup that overlaps itself at equal depth, strips,
// fans, lines and points wider than their pixel, a geometry and a tessellation stage.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cmath>
#include <vector>

using namespace programs;

namespace {

constexpr int kTriangles = 100000;

GLuint vertexArray, soup, plain, geometry, tessellation, points, flatPrimitives;

const char* const kVertex =
    "#version 330\nlayout(location = 0) in vec4 place; layout(location = 1) in vec4 tone; out vec4 tint;\n"
    "uniform mat4 turn; void main() { tint = tone; gl_Position = turn * place; }\n";
const char* const kFragment = "#version 330\nin vec4 tint; out vec4 result; void main() { result = tint; }\n";

void makeSoup() {
    Sequence numbers(77);
    std::vector<float> vertices;
    vertices.reserve(kTriangles * 3 * 8);
    for (int i = 0; i < kTriangles; ++i) {
        const float x = numbers.unit() * 2.4F - 1.2F, y = numbers.unit() * 2.4F - 1.2F,
                    z = numbers.unit() * 2.2F - 1.1F;
        const float size = i % 50 == 0 ? 0.2F : 0.02F;
        for (int corner = 0; corner < 3; ++corner) {
            const float at[8] = {x + size * (numbers.unit() - 0.5F),
                                 y + size * (numbers.unit() - 0.5F),
                                 z,
                                 1,
                                 numbers.unit(),
                                 numbers.unit(),
                                 numbers.unit(),
                                 1};
            vertices.insert(vertices.end(), at, at + 8);
        }
    }
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glGenBuffers(1, &soup);
    glBindBuffer(GL_ARRAY_BUFFER, soup);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size() * sizeof(float)), vertices.data(), GL_STATIC_DRAW);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 32, nullptr);
    glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, 32, reinterpret_cast<const void*>(16));
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
}

void setUp() {
    makeSoup();
    plain = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kFragment}});
    points = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 330\nlayout(location = 0) in vec4 place; layout(location = 1) in vec4 tone; out vec4 tint;\n"
          "uniform mat4 turn; void main() { tint = tone; gl_Position = turn * place; gl_PointSize = 2.0 + 60.0 * "
          "tone.x * tone.x; }\n"},
         {GL_FRAGMENT_SHADER, kFragment}});
    flatPrimitives = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 330\nlayout(location = 0) in vec4 place; layout(location = 1) in vec4 tone; flat out vec4 tint;\n"
          "uniform mat4 turn; void main() { tint = tone; gl_Position = turn * place; }\n"},
         {GL_FRAGMENT_SHADER, "#version 330\nflat in vec4 tint; out vec4 result; void main() { result = vec4(tint.rg, "
                              "float(gl_PrimitiveID & 7) / 7.0, 1); }\n"}});
    geometry = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 330\nlayout(location = 0) in vec4 place; layout(location = 1) in vec4 tone; out vec4 color;\n"
          "uniform mat4 turn; void main() { color = tone; gl_Position = turn * place; }\n"},
         {GL_GEOMETRY_SHADER,
          "#version 330\nlayout(triangles) in; layout(triangle_strip, max_vertices = 8) out; in vec4 color[]; out vec4 "
          "tint;\n"
          "void emit(vec4 p, vec4 c) { gl_Position = p; tint = c; EmitVertex(); }\n"
          "void main() { for (int k = 0; k < 2; ++k) { vec4 by = vec4(0.05, -0.03, 0, 0) * float(k);\n"
          "for (int i = 0; i < 3; ++i) emit(gl_in[i].gl_Position + by, color[i]);\n"
          "emit(gl_in[0].gl_Position + by + vec4(0.02, 0.02, 0, 0), color[0].bgra); EndPrimitive(); } }\n"},
         {GL_FRAGMENT_SHADER, kFragment}});
    tessellation = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 400\nlayout(location = 0) in vec4 place; layout(location = 1) in vec4 tone; out vec4 color;\n"
          "uniform mat4 turn; void main() { color = tone; gl_Position = turn * place; }\n"},
         {GL_TESS_CONTROL_SHADER,
          "#version 400\nlayout(vertices = 3) out; in vec4 color[]; out vec4 shade[];\n"
          "void main() { gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position; "
          "shade[gl_InvocationID] = color[gl_InvocationID];\n"
          "gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 3.0; gl_TessLevelInner[0] = 2.0; }\n"},
         {GL_TESS_EVALUATION_SHADER,
          "#version 400\nlayout(triangles, equal_spacing, ccw) in; in vec4 shade[]; out vec4 tint; void main() { vec3 "
          "t = gl_TessCoord;\n"
          "gl_Position = t.x * gl_in[0].gl_Position + t.y * gl_in[1].gl_Position + t.z * gl_in[2].gl_Position;\n"
          "tint = vec4(t.zyx * 0.5, 0) + 0.5 * shade[1]; }\n"},
         {GL_FRAGMENT_SHADER, kFragment}});
}

// Uses a program. The last column moves w through zero: some vertices lie behind the eye.
void use(GLuint program, int frame, float behind) {
    const float a = 0.02F * float(frame), c = std::cos(a), s = std::sin(a);
    const float turn[16] = {c, s, 0, 0.1F, -s, c, 0, -0.1F, 0, 0, 1, behind, 0, 0, 0, 1};
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "turn"), 1, GL_FALSE, turn);
}

void draw(const Window& window, int frame) {
    glClearColor(0.1F, 0.1F, 0.15F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    use(plain, frame, 0.3F);
    glDrawArrays(GL_TRIANGLES, 0, kTriangles * 3);
    use(flatPrimitives, frame, 1.2F);
    glDrawArrays(GL_TRIANGLE_STRIP, 30, 600);
    glDrawArrays(GL_TRIANGLE_FAN, 900, 40);
    use(geometry, frame, 0.5F);
    glDrawArrays(GL_TRIANGLES, 3000, 3000);
    use(tessellation, frame, 0.5F);
    glPatchParameteri(GL_PATCH_VERTICES, 3);
    glDrawArrays(GL_PATCHES, 9000, 3000);
    glLineWidth(5);
    use(plain, frame, 0.9F);
    glDrawArrays(GL_LINES, 12000, 300);
    glDrawArrays(GL_LINE_STRIP, 13000, 60);
    glLineWidth(60);
    glDrawArrays(GL_LINES, 15000, 6);
    glLineWidth(1);
    glEnable(GL_PROGRAM_POINT_SIZE);
    use(points, frame, 0.2F);
    glDrawArrays(GL_POINTS, 20000, 200);
    glDisable(GL_PROGRAM_POINT_SIZE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glViewport(window.width() / 3, window.height() / 4, window.width() / 2, window.height() / 2);
    use(plain, frame, 0.1F);
    glDrawArrays(GL_TRIANGLES, 21000, 900);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glViewport(0, 0, window.width(), window.height());
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); }, [](Window& window, int frame) { draw(window, frame); });
}
