// Positions in a fragment shader: gl_FragCoord with both origins and pixel centres, derivatives, gl_FrontFacing,
// gl_PointCoord, gl_FragDepth. Also early tests, interpolation qualifiers, gl_PrimitiveID, screen doors, and a ray
// caster that uses only its position.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <string>

using namespace programs;

namespace {

GLuint vertexArray;
GLuint programs_[8];

const char* const kBodies[8] = {
    "vec4 paint() { return vec4(fract(gl_FragCoord.xy / 32.0), fract(gl_FragCoord.z * 8.0), 1); }",
    "layout(origin_upper_left) in vec4 gl_FragCoord; vec4 paint() { return vec4(fract(gl_FragCoord.xy / 24.0), 0.3, "
    "1); }",
    "layout(origin_upper_left, pixel_center_integer) in vec4 gl_FragCoord;\n"
    "vec4 paint() { if (mod(gl_FragCoord.x + gl_FragCoord.y * 2.0, 5.0) < 1.0) discard; return vec4(0.8, 0.7, 0.1, 1); "
    "}",
    "layout(pixel_center_integer) in vec4 gl_FragCoord;\n"
    "vec4 paint() { ivec2 p = ivec2(gl_FragCoord.xy); return vec4(float((p.x ^ p.y) & 15) / 15.0, 0.2, 0.6, 1); }",
    "vec4 paint() { vec2 d = vec2(length(dFdx(corner)), length(dFdy(corner))) * 20.0;\n"
    "return vec4(fract(d * 3.0), fwidth(corner.x * corner.y) * 30.0, 1); }",
    "vec4 paint() { vec2 p = (gl_FragCoord.xy - size * 0.5) / size.y; float d = 1.0; vec3 o = vec3(0, 0, -2), r = "
    "normalize(vec3(p, 1.2));\n"
    "float t = 0.0; for (int i = 0; i < 24; ++i) { vec3 q = o + r * t; d = length(q - vec3(sin(frame), 0, 0)) - 0.7; t "
    "+= d; }\n"
    "return d < 0.01 ? vec4(normalize(o + r * t) * 0.5 + 0.5, 1) : vec4(p, 0.2, 1); }",
    "vec4 paint() { return gl_FrontFacing ? vec4(0.2, 0.9, float(gl_PrimitiveID & 3) / 3.0, 1) : vec4(0.9, 0.2, 0.2, "
    "1); }",
    "layout(early_fragment_tests) in; vec4 paint() { return vec4(interpolateAtCentroid(corner), "
    "interpolateAtOffset(corner, vec2(0.3)).x, 1); }",
};

void setUp() {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    for (int i = 0; i < 8; ++i) {
        const std::string fragment =
            std::string("#version 430\nin vec2 corner; uniform vec2 size; uniform float frame; out vec4 result;\n") +
            kBodies[i] + "\nvoid main() { result = paint();" +
            (i == 4 ? " gl_FragDepth = fract(corner.x * 3.0);" : "") + " }\n";
        programs_[i] = buildProgram(
            {{GL_VERTEX_SHADER, "#version 430\nuniform vec4 box; uniform float turn; out vec2 corner; void main() {\n"
                                "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1); vec2 p = corner * box.zw;\n"
                                "if (turn != 0.0 && gl_VertexID == 3) p -= vec2(turn);\n"
                                "gl_Position = vec4(box.xy + p, corner.x * 0.6 - 0.3, 1); }\n"},
             {GL_FRAGMENT_SHADER, fragment.c_str()}});
    }
}

void draw(int which, Window& window, int frame, float x, float y, float w, float h) {
    const GLuint program = programs_[which];
    glUseProgram(program);
    glUniform4f(glGetUniformLocation(program, "box"), x, y, w, h);
    glUniform1f(glGetUniformLocation(program, "turn"), which == 6 ? 0.45F : 0.0F);
    glUniform2f(glGetUniformLocation(program, "size"), float(window.width()), float(window.height()));
    glUniform1f(glGetUniformLocation(program, "frame"), float(frame) * 0.3F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window& window, int frame) {
            glClearColor(0.1F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glEnable(GL_DEPTH_TEST);
            draw(5, window, frame, -1, -1, 2, 1.1F);
            glClear(GL_DEPTH_BUFFER_BIT);
            const float shift = 0.01F * float(frame);
            for (int i = 0; i < 8; ++i) {
                if (i != 5) {
                    draw(i, window, frame, -0.97F + 0.245F * float(i), 0.15F + shift, 0.22F, 0.8F);
                }
            }
            // Draws after and in front of the depths that gl_FragDepth wrote.
            draw(0, window, frame, -0.1F, 0.3F, 0.5F, 0.2F);
            glDisable(GL_DEPTH_TEST);
        });
}
