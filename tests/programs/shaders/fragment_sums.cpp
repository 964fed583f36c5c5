// Fragments counted in a storage block, at a position that is known only during the draw. Depth and stencil of draws
// before the link of the counting program select them, in the middle of a picture.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr const char* kVertex = R"(#version 430
layout(location = 0) uniform vec4 box; layout(location = 1) uniform float depth;
void main() { gl_Position = vec4(mix(box.xy, box.zw, vec2(gl_VertexID & 1, gl_VertexID >> 1)), depth, 1); })";
constexpr const char* kPlain = "#version 430\nout vec4 result; void main() { result = vec4(0.2, 0.8, 0.3, 1); }";
constexpr const char* kCounting = R"(#version 430
layout(std430, binding = 1) readonly buffer Weights { uint weights[]; };
layout(std430, binding = 2) buffer Sums { uint sums[]; };
out vec4 result;
void main() {
    uint column = uint(gl_FragCoord.x) >> 4;
    if (sums.length() > 8) atomicAdd(sums[column % 8u], weights[column & 3u]);
    result = vec4(float(column & 7u) / 7.0, 0.4, 0.5, 1);
})";

GLuint plain, counting;

void box(GLuint program, float x0, float y0, float x1, float y1, float depth) {
    glUseProgram(program);
    glUniform4f(0, x0, y0, x1, y1);
    glUniform1f(1, depth);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// Draws depth and stencil that hide part of the counted fragments.
void drawBefore() {
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 1, ~0U);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    box(plain, -0.7F, -0.6F, 0.5F, 0.4F, -0.5F);
    glStencilFunc(GL_ALWAYS, 0, ~0U);
    box(plain, 0.3F, 0.1F, 0.8F, 0.9F, 0.6F);
}

void drawCounted() {
    const GLuint zero[16] = {};
    const GLuint weights[4] = {1, 3, 5, 7};
    GLuint buffers[2] = {};
    glGenBuffers(2, buffers);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers[0]);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof weights, weights, GL_STATIC_DRAW);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, buffers[1]);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof zero, zero, GL_DYNAMIC_COPY);
    glStencilFunc(GL_NOTEQUAL, 1, ~0U);
    box(counting, -0.9F, -0.9F, 0.7F, 0.8F, 0);
    glStencilFunc(GL_ALWAYS, 0, ~0U);
    box(counting, -0.2F, -0.8F, 0.9F, 0.6F, 0.2F);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_STENCIL_TEST);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    GLuint readBack[8] = {};
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof readBack, readBack);
    for (int i = 0; i < 8; ++i) {
        showBits(30 + i, readBack[i]);
    }
    glDeleteBuffers(2, buffers);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            GLuint vertexArray = 0;
            glGenVertexArrays(1, &vertexArray);
            glBindVertexArray(vertexArray);
            plain = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kPlain}});
        },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.12F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
            drawBefore();
            if (frame == 0) {
                counting = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kCounting}});
            }
            drawCounted();
        });
}
