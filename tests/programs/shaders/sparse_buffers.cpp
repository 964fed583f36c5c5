// Buffers with only some pages: vertices, uniform blocks and storage in committed pages. The program, copies and
// shaders write them. Pages are released and committed again. Only committed pages are read, because the rest is
// undefined.
#include <cstdint>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/needs.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kPages = 8, kPoints = 64;
GLint pageBytes;
GLuint buffer, source, program, write, vertexArray;

void setUp(Window&) {
    needExtension("GL_ARB_sparse_buffer");
    program = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 430\nlayout(location=0) in vec4 point; layout(std140, binding=0) uniform Move { vec4 offset; };\n"
          "out vec3 shade; void main() { shade = vec3(point.zw, 0.7); gl_PointSize = 7.0; gl_Position = vec4(point.xy "
          "+ offset.xy, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER,
          "#version 430\nin vec3 shade; out vec4 result; void main() { result = vec4(shade, 1); }\n"}});
    write = buildProgram({{GL_COMPUTE_SHADER, R"(#version 430
layout(local_size_x=64) in; layout(std430, binding=1) buffer Points { vec4 points[]; }; uniform int frame;
void main() { uint i = gl_GlobalInvocationID.x; points[i] = vec4(float(i % 8u) * 0.05, float(i / 8u) * 0.05, float(i) / 64.0, float(frame) * 0.25); })"}});
    glGetIntegerv(GL_SPARSE_BUFFER_PAGE_SIZE_ARB, &pageBytes);
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    GLuint buffers[2];
    glGenBuffers(2, buffers);
    buffer = buffers[0], source = buffers[1];
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferStorage(GL_ARRAY_BUFFER, GLsizeiptr(kPages) * pageBytes, nullptr,
                    GL_SPARSE_STORAGE_BIT_ARB | GL_DYNAMIC_STORAGE_BIT);
    glEnableVertexAttribArray(0);
    glEnable(GL_PROGRAM_POINT_SIZE);
    GLfloat points[kPoints * 4];
    Sequence numbers(3);
    for (int i = 0; i < kPoints * 4; ++i) {
        points[i] = i % 4 < 2 ? numbers.unit() * 0.4F : numbers.unit();
    }
    glBindBuffer(GL_COPY_READ_BUFFER, source);
    glBufferData(GL_COPY_READ_BUFFER, sizeof points, points, GL_STATIC_COPY);
}

void commit(int page, int count, bool committed) {
    glBufferPageCommitmentARB(GL_ARRAY_BUFFER, GLintptr(page) * pageBytes, GLsizeiptr(count) * pageBytes,
                              committed ? GL_TRUE : GL_FALSE);
}

void draw(int page, float x, float y) {
    const GLfloat offset[4] = {x, y, 0, 0};
    glBufferSubData(GL_ARRAY_BUFFER, GLintptr(7) * pageBytes, sizeof offset, offset);
    glBindBufferRange(GL_UNIFORM_BUFFER, 0, buffer, GLintptr(7) * pageBytes, sizeof offset);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, reinterpret_cast<void*>(std::intptr_t(page) * pageBytes));
    glUseProgram(program);
    glDrawArrays(GL_POINTS, 0, kPoints);
}

void drawFrame(Window&, int frame) {
    glClearColor(0.12F, 0.1F, 0.16F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (frame == 0) {
        commit(7, 1, true);
        commit(0, 1, true);
        glNamedBufferPageCommitmentARB(buffer, GLintptr(5) * pageBytes, pageBytes, GL_TRUE);
    }
    GLfloat points[kPoints * 4];
    Sequence numbers(unsigned(frame) + 11);
    for (int i = 0; i < kPoints * 4; ++i) {
        points[i] = i % 4 < 2 ? numbers.unit() * 0.4F : numbers.unit();
    }
    glBufferSubData(GL_ARRAY_BUFFER, 0, sizeof points, points);
    const int moving = 1 + frame % 3; // pages are committed and released
    if (frame > 0) {
        commit(1 + (frame + 2) % 3, 1, false);
    }
    commit(moving, 1, true);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_ARRAY_BUFFER, 0, GLintptr(moving) * pageBytes, sizeof points);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 1, buffer, GLintptr(5) * pageBytes, pageBytes);
    glUseProgram(write);
    glUniform1i(glGetUniformLocation(write, "frame"), frame);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    draw(0, -0.9F, -0.6F);
    draw(moving, -0.2F, -0.6F);
    draw(5, 0.4F, -0.6F);
    commit(0, 2, true); // the first is committed already
    draw(0, -0.5F, 0.2F);
    showBits(0, GLuint(pageBytes));
    GLfloat first = 0;
    glGetBufferSubData(GL_ARRAY_BUFFER, GLintptr(5) * pageBytes + 17 * 16, sizeof first, &first);
    showBits(1, first);
    commit(0, 0, true);
    showBits(2, glGetError());
    glBufferPageCommitmentARB(GL_ARRAY_BUFFER, 1, pageBytes, GL_TRUE);
    showBits(3, glGetError());
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {Profile::Core, 4, 5}, setUp, drawFrame); }
