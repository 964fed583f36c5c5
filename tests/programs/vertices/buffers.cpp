// Buffer objects: data, sub-data, whole and partial maps, invalidated, unsynchronized and explicitly flushed ranges,
// copies, clears, orphaning, reads.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>

using namespace programs;

namespace {

constexpr int kBars = 16;
constexpr GLsizeiptr kSize = kBars * 6 * 8;
GLuint program, vertexArray;
GLuint buffers[10];

// Writes two triangles per bar; the heights depend on `seed`.
void fillBars(GLfloat* out, unsigned seed, int first = 0, int count = kBars) {
    for (int bar = first; bar < first + count; ++bar) {
        Sequence numbers(seed * 100 + unsigned(bar));
        const float left = -0.95F + float(bar) * 0.12F;
        const float right = left + 0.1F;
        const float top = 0.03F + numbers.unit() * 0.15F;
        const GLfloat corners[12] = {left, 0, right, 0, right, top, left, 0, right, top, left, top};
        std::memcpy(out + (bar - first) * 12, corners, sizeof corners);
    }
}

void draw(int row) {
    glUniform2f(0, 0, -0.97F + 0.19F * float(row));
    glUniform1f(1, float(row) * 0.1F);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glDrawArrays(GL_TRIANGLES, 0, kBars * 6);
}

void bind(int index) { glBindBuffer(GL_ARRAY_BUFFER, buffers[index]); }

void drawData(unsigned seed) {
    GLfloat bars[kBars * 12];
    fillBars(bars, seed);
    bind(0);
    glBufferData(GL_ARRAY_BUFFER, kSize, bars, GL_STREAM_DRAW); // orphans the data of the last frame
    fillBars(bars, seed + 50);
    draw(0);
    bind(1);
    glBufferSubData(GL_ARRAY_BUFFER, 0, kSize / 2, bars);
    glBufferSubData(GL_ARRAY_BUFFER, kSize / 2 + 48, 96, bars);
    draw(1);
}

void drawMapped(unsigned seed) {
    bind(2);
    auto* bars = static_cast<GLfloat*>(glMapBuffer(GL_ARRAY_BUFFER, GL_WRITE_ONLY));
    fillBars(bars, seed + 1);
    glUnmapBuffer(GL_ARRAY_BUFFER);
    draw(2);
    // Reads and writes: the new contents depend on the old ones.
    bars = static_cast<GLfloat*>(glMapBuffer(GL_ARRAY_BUFFER, GL_READ_WRITE));
    for (int i = 1; i < kBars * 12; i += 4) {
        bars[i] *= 0.7F;
    }
    glUnmapBuffer(GL_ARRAY_BUFFER);
    draw(3);
}

void drawMappedRanges(unsigned seed) {
    bind(3);
    const GLbitfield write = GL_MAP_WRITE_BIT;
    const GLsizeiptr quarter = kSize / 4;
    auto* range =
        static_cast<GLfloat*>(glMapBufferRange(GL_ARRAY_BUFFER, 0, kSize, write | GL_MAP_INVALIDATE_BUFFER_BIT));
    fillBars(range, seed + 2);
    glUnmapBuffer(GL_ARRAY_BUFFER);
    range =
        static_cast<GLfloat*>(glMapBufferRange(GL_ARRAY_BUFFER, quarter, quarter, write | GL_MAP_INVALIDATE_RANGE_BIT));
    fillBars(range, seed + 3, kBars / 4, kBars / 4);
    glUnmapBuffer(GL_ARRAY_BUFFER);
    draw(4);
    glFinish(); // nothing reads the buffer while it is written unsynchronized
    range = static_cast<GLfloat*>(
        glMapBufferRange(GL_ARRAY_BUFFER, 2 * quarter, quarter, write | GL_MAP_UNSYNCHRONIZED_BIT));
    fillBars(range, seed + 4, kBars / 2, kBars / 4);
    glUnmapBuffer(GL_ARRAY_BUFFER);
    draw(5);
}

void drawFlushedRanges(unsigned seed) {
    bind(4);
    auto* range = static_cast<GLfloat*>(
        glMapBufferRange(GL_ARRAY_BUFFER, 96, kSize - 96, GL_MAP_WRITE_BIT | GL_MAP_FLUSH_EXPLICIT_BIT));
    fillBars(range, seed + 5, 2, 4);
    glFlushMappedBufferRange(GL_ARRAY_BUFFER, 0, 48 * 4);
    fillBars(range + 12 * 8, seed + 6, 10, 2);
    glFlushMappedBufferRange(GL_ARRAY_BUFFER, 48 * 8, 48 * 2);
    glUnmapBuffer(GL_ARRAY_BUFFER);
    draw(6);
}

void drawCopies(unsigned seed) {
    glBindBuffer(GL_COPY_READ_BUFFER, buffers[0]);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffers[5]);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, kSize);
    glBindBuffer(GL_COPY_READ_BUFFER, buffers[2]);
    const auto shift = GLintptr(seed % 3) * 48;
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 48 * 4, 48 * 4 + shift, 48 * 5);
    bind(5);
    draw(7);
    // Within one buffer.
    glBindBuffer(GL_COPY_READ_BUFFER, buffers[5]);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 48 * 12, 48 * 3);
    // Cleared parts.
    const GLfloat zero = 0;
    glClearBufferSubData(GL_ARRAY_BUFFER, GL_R32F, 48 * 2, 48, GL_RED, GL_FLOAT, &zero);
    draw(8);
}

void showReadBack() {
    bind(5);
    GLuint readBack[4] = {};
    glGetBufferSubData(GL_ARRAY_BUFFER, 48 * 5, sizeof readBack, readBack);
    for (int i = 0; i < 3; ++i) {
        showBits(35 + i, readBack[i]);
    }
    const auto* mapped = static_cast<const GLuint*>(glMapBuffer(GL_ARRAY_BUFFER, GL_READ_ONLY));
    showBits(34, mapped[12 * 5 + 2]);
    glUnmapBuffer(GL_ARRAY_BUFFER);
}

void setUp() {
    program = buildProgram(
        {{GL_VERTEX_SHADER, "#version 430\nlayout(location=0) in vec2 place; layout(location=0) uniform vec2 offset;\n"
                            "void main() { gl_Position = vec4(place + offset, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER, "#version 430\nlayout(location=1) uniform float tint; out vec4 result;\n"
                              "void main() { result = vec4(1.0 - tint, 0.4 + tint * 0.5, tint, 1); }\n"}});
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glEnableVertexAttribArray(0);
    glGenBuffers(10, buffers);
    GLfloat bars[kBars * 12];
    for (int i = 0; i < 10; ++i) {
        fillBars(bars, unsigned(i) + 900);
        bind(i);
        if (i == 4) {
            glBufferStorage(GL_ARRAY_BUFFER, kSize, bars, GL_MAP_WRITE_BIT | GL_DYNAMIC_STORAGE_BIT);
        } else {
            glBufferData(GL_ARRAY_BUFFER, kSize, bars, GL_DYNAMIC_DRAW);
        }
    }
}

// Creates and deletes names between frames.
void churn(unsigned seed) {
    glDeleteBuffers(2, buffers + 8);
    glGenBuffers(2, buffers + 8);
    GLfloat bars[kBars * 12];
    fillBars(bars, seed + 70);
    bind(9);
    glBufferData(GL_ARRAY_BUFFER, kSize, bars, GL_STATIC_DRAW);
    draw(9);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 4};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            glUseProgram(program);
            const unsigned seed = unsigned(frame) * 10;
            drawData(seed);
            drawMapped(seed);
            drawMappedRanges(seed);
            drawFlushedRanges(seed);
            drawCopies(unsigned(frame));
            churn(seed);
            showReadBack();
        });
}
