// Uniforms of all types, arrays and structures, through glUniform and glProgramUniform, with locations of one program;
// values persist over frames. Each value is one coloured cell.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <string>

using namespace programs;

namespace {

GLuint vertexArray, program, other;
GLuint textures[3];

const char* const kVertex = "#version 430\nout vec2 corner; uniform vec4 box; void main() {\n"
                            "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                            "gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n";

// Cell number n of an 8×8 grid shows the n-th uniform.
const char* const kFragment = R"(#version 430
in vec2 corner; out vec4 result;
struct Inner { float weight; vec2 pair[2]; };
struct Light { vec3 color; Inner inner; ivec2 steps; mat2 turn; };
uniform float f1; uniform vec2 f2; uniform vec3 f3; uniform vec4 f4;
uniform int i1; uniform ivec2 i2; uniform ivec3 i3; uniform ivec4 i4;
uniform uint u1; uniform uvec2 u2; uniform uvec3 u3; uniform uvec4 u4;
uniform bool b1; uniform bvec2 b2; uniform bvec4 b4;
uniform double d1; uniform dvec2 d2; uniform dvec3 d3; uniform dvec4 d4;
uniform mat2 m2; uniform mat3 m3; uniform mat4 m4;
uniform mat2x3 m23; uniform mat3x2 m32; uniform mat2x4 m24; uniform mat4x2 m42;
uniform mat3x4 m34; uniform mat4x3 m43; uniform dmat2 e2; uniform dmat3x4 e34;
uniform float many[5]; uniform vec4 colors[3]; uniform mat3 turns[2];
uniform Light lights[2]; uniform sampler2D images[3];
layout(location=77) uniform vec3 placed;
uniform float preset = 0.65;
vec3 value(int n) {
  switch (n) {
  case 0: return vec3(f1); case 1: return vec3(f2, 0); case 2: return f3; case 3: return f4.rgb * f4.a;
  case 4: return vec3(i1) / 9.0; case 5: return vec3(i2, 0) / 9.0; case 6: return vec3(i3) / 9.0; case 7: return vec3(i4.xyz) / 9.0;
  case 8: return vec3(u1) / 9.0; case 9: return vec3(u2, 1) / 9.0; case 10: return vec3(u3) / 9.0; case 11: return vec3(u4.wzy) / 9.0;
  case 12: return vec3(b1); case 13: return vec3(b2, 0); case 14: return vec3(b4.xzw);
  case 15: return vec3(d1); case 16: return vec3(d2, 0); case 17: return vec3(d3); case 18: return vec3(d4.wyz);
  case 19: return vec3(m2[0], m2[1].y); case 20: return m3 * vec3(0.3, 0.2, 0.1); case 21: return (m4 * vec4(0.3, 0.2, 0.1, 0.4)).xyz;
  case 22: return m23[1]; case 23: return vec3(m32[2], m32[0].x); case 24: return m24[1].yzw; case 25: return vec3(m42[3], m42[1].y);
  case 26: return m34[2].xyz; case 27: return m43[3]; case 28: return vec3(e2[1], e2[0].x); case 29: return vec3(e34[1].xyw);
  case 30: return vec3(many[0], many[2], many[4]); case 31: return vec3(many[1], many[3], 0);
  case 32: return colors[0].rgb; case 33: return colors[2].bgr; case 34: return turns[1] * vec3(0.2, 0.4, 0.3);
  case 35: return lights[0].color; case 36: return lights[1].color; case 37: return vec3(lights[1].inner.weight);
  case 38: return vec3(lights[0].inner.pair[1], 0.5); case 39: return vec3(lights[1].inner.pair[0], 0);
  case 40: return vec3(lights[1].steps, 3) / 9.0; case 41: return vec3(lights[0].turn[1], 0.2);
  case 42: return texture(images[0], corner).rgb; case 43: return texture(images[1], corner).rgb; case 44: return texture(images[2], corner).rgb;
  case 45: return placed; case 46: return vec3(preset); default: return vec3(0.1); }
}
void main() { ivec2 cell = ivec2(corner * 7.999); result = vec4(abs(value(cell.y * 8 + cell.x)), 1); }
)";

GLint at(const std::string& name) {
    const GLint location = glGetUniformLocation(program, name.c_str());
    if (location < 0) {
        fail("no uniform %s", name.c_str());
    }
    return location;
}

void setScalars(int frame) {
    const auto t = float(frame) * 0.1F;
    glUniform1f(at("f1"), 0.3F + t);
    glUniform2f(at("f2"), 0.2F, t);
    glUniform3f(at("f3"), t, 0.5F, 0.9F);
    const GLfloat four[] = {0.9F, t, 0.4F, 0.8F};
    glUniform4fv(at("f4"), 1, four);
    glUniform1i(at("i1"), frame + 1);
    glUniform2i(at("i2"), 8, -frame);
    const GLint ints[] = {3, 5 + frame, 7, 2};
    glUniform3iv(at("i3"), 1, ints);
    glUniform4iv(at("i4"), 1, ints);
    const GLuint naturals[] = {1, 4U + GLuint(frame), 6, 9};
    glUniform1ui(at("u1"), naturals[1]);
    glUniform2uiv(at("u2"), 1, naturals);
    glUniform3ui(at("u3"), 9, 0, GLuint(frame));
    glUniform4uiv(at("u4"), 1, naturals);
    glUniform1i(at("b1"), frame % 2);
    glUniform2f(at("b2"), 0, 3);
    glUniform4ui(at("b4"), 1, 1, GLuint(frame % 2), 0);
    glUniform1d(at("d1"), 0.2 + frame * 0.1);
    glUniform2d(at("d2"), 0.8, frame * 0.1);
    const GLdouble doubles[] = {0.1, 0.4 + frame * 0.1, 0.7, 1};
    glUniform3dv(at("d3"), 1, doubles);
    glUniform4dv(at("d4"), 1, doubles);
}

void setMatrices(int frame) {
    GLfloat f[24];
    GLdouble d[24];
    for (int i = 0; i < 24; ++i) {
        f[i] = float((i * 7 + frame) % 10) / 10.0F;
        d[i] = double((i * 3 + frame * 2) % 10) / 10.0;
    }
    glUniformMatrix2fv(at("m2"), 1, GL_FALSE, f);
    glUniformMatrix3fv(at("m3"), 1, GL_TRUE, f + 1);
    glUniformMatrix4fv(at("m4"), 1, GL_FALSE, f + 2);
    glUniformMatrix2x3fv(at("m23"), 1, GL_FALSE, f + 3);
    glUniformMatrix3x2fv(at("m32"), 1, GL_TRUE, f + 4);
    glUniformMatrix2x4fv(at("m24"), 1, GL_FALSE, f + 5);
    glUniformMatrix4x2fv(at("m42"), 1, GL_TRUE, f + 6);
    glUniformMatrix3x4fv(at("m34"), 1, GL_FALSE, f + 7);
    glUniformMatrix4x3fv(at("m43"), 1, GL_TRUE, f + 8);
    glUniformMatrix2dv(at("e2"), 1, GL_FALSE, d);
    glUniformMatrix3x4dv(at("e34"), 1, GL_TRUE, d + 2);
}

void setArrays(int frame) {
    const GLfloat many[] = {0.1F, 0.3F, 0.5F, 0.7F, 0.9F};
    glUniform1fv(at("many"), 5, many);
    glUniform1f(at("many[2]"), float(frame) * 0.2F);
    glUniform1fv(at("many[3]"), 2, many + (frame % 3));
    GLfloat colors[12];
    GLfloat turns[18];
    for (int i = 0; i < 18; ++i) {
        turns[i] = float((i * 5 + frame) % 7) / 7.0F;
        colors[i % 12] = float((i * 11 + frame) % 9) / 9.0F;
    }
    glUniform4fv(at("colors"), 3, colors);
    glUniformMatrix3fv(at("turns[0]"), 2, GL_FALSE, turns);
    glUniform3f(at("lights[0].color"), 0.9F, 0.2F * float(frame), 0);
    glUniform3fv(at("lights[1].color"), 1, colors);
    glUniform1f(at("lights[1].inner.weight"), 0.25F * float(frame % 4));
    glUniform2fv(at("lights[0].inner.pair"), 2, colors + 2);
    glUniform2fv(at("lights[1].inner.pair[0]"), 1, colors + 5);
    glUniform2i(at("lights[1].steps"), frame, 4);
    glUniformMatrix2fv(at("lights[0].turn"), 1, GL_FALSE, turns);
    const GLint units[] = {2, 0, 1};
    glUniform1iv(at("images"), 3, units);
    glUniform3f(77, 0.1F * float(frame), 0.9F, 0.4F);
    if (frame == 2) {
        glUniform1f(at("preset"), 0.1F); // has the initial value of the source before this
    }
}

// Sets uniforms of the second program, which is not in use.
void setOther(int frame) {
    setScalars(frame);
    const GLint saved = at("f3");
    glUseProgram(0);
    glProgramUniform3f(other, glGetUniformLocation(other, "f3"), 0.2F, 1, 0.1F * float(frame));
    glProgramUniform1i(other, glGetUniformLocation(other, "i1"), 9 - frame);
    const GLfloat matrix[] = {0.5F, 0.1F, 0.2F, float(frame) * 0.2F};
    glProgramUniformMatrix2fv(other, glGetUniformLocation(other, "m2"), 1, GL_FALSE, matrix);
    glProgramUniform4d(other, glGetUniformLocation(other, "d4"), 0.3, 0.6, 0.9, 0.1 * frame);
    GLfloat readBack[3] = {};
    glGetUniformfv(program, saved, readBack);
    showBits(0, readBack[0]);
    GLint active = 0;
    glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &active);
    showBits(1, std::uint32_t(active));
}

void setUp() {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    program = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kFragment}});
    other = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kFragment}});
    glGenTextures(3, textures);
    for (unsigned i = 0; i < 3; ++i) {
        GLubyte texels[2 * 2 * 4];
        Sequence numbers(i + 40);
        for (GLubyte& value : texels) {
            value = numbers.byte();
        }
        glActiveTexture(GL_TEXTURE0 + i);
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    }
}

void drawWith(GLuint which, float x) {
    glUseProgram(which);
    glUniform4f(glGetUniformLocation(which, "box"), x, -0.85F, 0.9F, 1.8F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            glUseProgram(program);
            setScalars(frame);
            setMatrices(frame);
            setArrays(frame);
            drawWith(program, -0.95F);
            setOther(frame);
            drawWith(other, 0.05F);
        });
}
