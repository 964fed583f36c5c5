// The program's own memory as a buffer (AMD_pinned_memory): written between draws, mapped, filled by a compute shader
// and by reads of pixels. Without the extension only a background is drawn.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdlib>
#include <cstring>

using namespace programs;

namespace {

constexpr GLsizeiptr kBytes = 1 << 18;
constexpr GLsizeiptr kResults = 4096, kPixels = 8192; // offsets in it
GLubyte* memory;
GLuint buffer, program, compute, vertexArray;

bool hasExtension() {
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        if (std::strcmp(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i))),
                        "GL_AMD_pinned_memory") == 0) {
            return true;
        }
    }
    return false;
}

void setUp() {
    if (!hasExtension()) {
        return;
    }
    memory = static_cast<GLubyte*>(std::aligned_alloc(4096, kBytes));
    std::memset(memory, 0, kBytes);
    program = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 430\nlayout(location=0) in vec2 place; layout(location=0) uniform vec4 tint; out vec4 shade;\n"
          "void main() { shade = tint; gl_Position = vec4(place, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER, "#version 430\nin vec4 shade; out vec4 result; void main() { result = shade; }\n"}});
    compute = buildProgram({{GL_COMPUTE_SHADER, R"(#version 430
layout(local_size_x=8) in; layout(std430, binding=0) buffer All { uint values[]; }; layout(location=0) uniform uint frame;
void main() { uint i = gl_LocalInvocationIndex; values[i] = values[i] * 3u + i * 1001u + frame; })"}});
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, buffer);
    glBufferData(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, kBytes, memory, GL_STREAM_DRAW);
    glBindBuffer(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, 0);
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
}

void writeTriangles(void* to, int seed) {
    Sequence numbers{unsigned(seed)};
    GLfloat places[24];
    for (GLfloat& p : places) {
        p = numbers.unit() * 1.8F - 0.9F;
    }
    std::memcpy(to, places, sizeof places);
}

void drawFrame(int frame) {
    glUseProgram(program);
    glUniform4f(0, 0.9F, 0.5F, 0.2F, 1);
    writeTriangles(memory, frame);
    glDrawArrays(GL_TRIANGLES, 0, 12);
    writeTriangles(memory + 96, frame + 50);
    glDrawArrays(GL_TRIANGLES, 12, 6);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    auto* mapped = static_cast<GLubyte*>(glMapBufferRange(GL_ARRAY_BUFFER, 192, 96, GL_MAP_WRITE_BIT));
    if (mapped == nullptr) {
        fail("pinned memory can't be mapped");
    }
    writeTriangles(mapped, frame + 90);
    glUnmapBuffer(GL_ARRAY_BUFFER);
    glUniform4f(0, 0.2F, 0.5F, 0.9F, 1);
    glDrawArrays(GL_TRIANGLES, 24, 6);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, buffer, kResults, 64);
    glUseProgram(compute);
    glUniform1ui(0, GLuint(frame));
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glReadPixels(100, 80, 2, 2, GL_RGBA, GL_UNSIGNED_BYTE, reinterpret_cast<void*>(kPixels));
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glFinish();
    for (int i = 0; i < 8; ++i) {
        std::uint32_t value = 0;
        std::memcpy(&value, memory + (i < 4 ? kResults : kPixels - 16) + i * 4, 4);
        showBits(i, value);
    }
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.12F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            if (memory != nullptr) {
                drawFrame(frame);
            }
        });
}
