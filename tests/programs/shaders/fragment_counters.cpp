// Fragment shaders with side effects: atomic counters, and sums and maxima in a storage block, each independent of the
// order of the fragments. The results are read and drawn as bits.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint vertexArray, plain, counting, counterBuffer;

// Draws with sums that do not depend on the order of fragments.
void drawCounted(int frame) {
    const GLuint zero[80] = {};
    glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, counterBuffer);
    glBufferData(GL_ATOMIC_COUNTER_BUFFER, 16, zero, GL_DYNAMIC_COPY);
    glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, counterBuffer);
    GLuint sums = 0;
    glGenBuffers(1, &sums);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, sums);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof zero, zero, GL_DYNAMIC_COPY);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, sums);
    glEnable(GL_DEPTH_TEST); // fragments hidden by the depth of other draws are not counted
    glUseProgram(plain);
    glUniform1f(0, 0.3F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glUseProgram(counting);
    glUniform1f(0, 0.03F * float(frame));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_DEPTH_TEST);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_ATOMIC_COUNTER_BARRIER_BIT);
    GLuint counts[2] = {};
    GLuint readBack[65] = {};
    glGetBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, sizeof counts, counts);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof readBack, readBack);
    showBits(36, counts[0]);
    showBits(35, counts[1]);
    showBits(34, readBack[0]);
    showBits(33, readBack[17]);
    glDeleteBuffers(1, &sums);
}

void makePlain() {
    plain = buildProgram(
        {{GL_VERTEX_SHADER, "#version 430\nlayout(location=0) uniform float shift; void main() { vec2 c = "
                            "vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                            "gl_Position = vec4(c * 0.9 - 0.9 + shift, -0.5, 1); }\n"},
         {GL_FRAGMENT_SHADER, "#version 430\nout vec4 result; void main() { result = vec4(0.2, 0.8, 0.3, 1); }\n"}});
}

void makeCounting() {
    counting = buildProgram({{GL_VERTEX_SHADER, "#version 430\nlayout(location=0) uniform float shift; void main() { "
                                                "vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                                "gl_Position = vec4(c * 1.4 - 0.9 + shift, 0, 1); }\n"},
                             {GL_FRAGMENT_SHADER, R"(#version 430
        layout(early_fragment_tests) in; layout(binding=0, offset=0) uniform atomic_uint drawn; layout(binding=0, offset=4) uniform atomic_uint bright;
        layout(std430, binding=3) buffer Sums { uint sum; uint columns[64]; };
        out vec4 result; void main() { atomicCounterIncrement(drawn); uint x = uint(gl_FragCoord.x);
        if ((x & 4u) != 0u) atomicCounterIncrement(bright); atomicAdd(sum, x & 3u); atomicMax(columns[x & 63u], uint(gl_FragCoord.y));
        result = vec4(float(x & 7u) / 7.0, 0.4, 0.5, 1); })"}});
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            glGenVertexArrays(1, &vertexArray);
            glBindVertexArray(vertexArray);
            glGenBuffers(1, &counterBuffer);
            makePlain();
        },
        [](Window& window, int frame) {
            glClearColor(0.1F, 0.12F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            for (int i = 0; i < 9; ++i) {
                fillRectangle(window.width() * i / 9, window.height() * i / 9, 25, 15, {0.9F, float(i) / 9, 0.2F});
            }
            if (frame == 1) {
                makeCounting(); // in the middle of a picture: earlier drawing remains
            }
            if (frame > 0) {
                drawCounted(frame);
            }
        });
}
