// Buffers whose contents change after nodes know them, by every way to write a buffer. Each change moves a mesh from
// the left to the right.
#include <cstring>

#include "tests/programs/culling/meshes.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kWays = 9;
constexpr GLsizei kCells = 12;
constexpr GLsizeiptr kBytes = kCells * kCells * 6 * static_cast<GLsizeiptr>(sizeof(Vertex));
GLuint buffers[kWays], other, feedback, indices;
void* persistent = nullptr;

std::vector<Vertex> contents(int way, bool isRight) {
    std::vector<Vertex> vertices = field(kCells, kCells, 6);
    for (Vertex& v : vertices) {
        v.x = 0.3F * v.x + (isRight ? 0.6F : -0.6F);
        v.y = 0.09F * v.y + 0.2F * static_cast<float>(way) - 0.85F;
    }
    return vertices;
}

void setUp(Window&) {
    for (int way = 0; way < kWays; ++way)
        buffers[way] = bufferOf(GL_ARRAY_BUFFER, kBytes, contents(way, false).data(), GL_DYNAMIC_DRAW);
    other = bufferOf(GL_ARRAY_BUFFER, kBytes, nullptr);
    std::vector<GLuint> numbers;
    for (GLuint i = 0; i < kCells * kCells * 6; ++i) numbers.push_back(i);
    indices = bufferOf(GL_ELEMENT_ARRAY_BUFFER, numbers.size() * 4, numbers.data());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    feedback = buildProgram({{GL_VERTEX_SHADER, "#version 150 compatibility\n"
                                                "in vec4 place; in vec4 tint; out vec4 moved; out vec4 shade;\n"
                                                "void main() { moved = place; shade = tint; gl_Position = place; }"}},
                            [](unsigned program) {
                                const char* names[] = {"moved"};
                                glBindAttribLocation(program, 0, "place");
                                glBindAttribLocation(program, 1, "tint");
                                glTransformFeedbackVaryings(program, 1, names, GL_INTERLEAVED_ATTRIBS);
                            });
    const GLbitfield flags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glDeleteBuffers(1, &buffers[7]);
    glGenBuffers(1, &buffers[7]);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[7]);
    glBufferStorage(GL_ARRAY_BUFFER, kBytes, contents(7, false).data(), flags | GL_DYNAMIC_STORAGE_BIT);
    persistent = glMapBufferRange(GL_ARRAY_BUFFER, 0, kBytes, flags);
}

// Captures the vertices of another buffer. They have four floats each, and no colours.
void capture(GLuint to, int way, bool isRight) {
    glBindBuffer(GL_ARRAY_BUFFER, other);
    glBufferSubData(GL_ARRAY_BUFFER, 0, kBytes, contents(way, isRight).data());
    glUseProgram(feedback);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offsetOf(0));
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, to);
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_TRIANGLES);
    glDrawArrays(GL_TRIANGLES, 0, kCells * kCells * 6);
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    glDisableVertexAttribArray(0);
    glUseProgram(0);
}

void write(int way, bool isRight) {
    const std::vector<Vertex> wanted = contents(way, isRight);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[way]);
    switch (way) {
    case 0: glBufferData(GL_ARRAY_BUFFER, kBytes, wanted.data(), GL_DYNAMIC_DRAW); break;
    case 1: glBufferSubData(GL_ARRAY_BUFFER, 0, kBytes, wanted.data()); break;
    case 2:
        std::memcpy(glMapBuffer(GL_ARRAY_BUFFER, GL_WRITE_ONLY), wanted.data(), kBytes);
        glUnmapBuffer(GL_ARRAY_BUFFER);
        break;
    case 3:
        std::memcpy(glMapBufferRange(GL_ARRAY_BUFFER, 0, kBytes, GL_MAP_WRITE_BIT | GL_MAP_FLUSH_EXPLICIT_BIT),
                    wanted.data(), kBytes);
        glFlushMappedBufferRange(GL_ARRAY_BUFFER, 0, kBytes);
        glUnmapBuffer(GL_ARRAY_BUFFER);
        break;
    case 4:
        glBindBuffer(GL_COPY_READ_BUFFER, other);
        glBufferSubData(GL_COPY_READ_BUFFER, 0, kBytes, wanted.data());
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_ARRAY_BUFFER, 0, 0, kBytes);
        break;
    case 5: glNamedBufferSubData(buffers[way], 0, kBytes, wanted.data()); break;
    case 6: capture(buffers[way], way, isRight); break;
    case 7: std::memcpy(persistent, wanted.data(), kBytes); break;
    default: { // the indices change: a part of the mesh, from the left or from the right
        std::vector<GLuint> numbers;
        for (GLuint i = 0; i < kCells * kCells * 6; ++i) numbers.push_back(isRight ? i : i / 2);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(numbers.size() * 4), numbers.data());
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    }
    }
}

void drawBuffers() {
    for (int way = 0; way < kWays; ++way) {
        glBindBuffer(GL_ARRAY_BUFFER, buffers[way]);
        glColor3ub(static_cast<GLubyte>(25 * way + 30), 220, 90);
        if (way == 6)
            glVertexPointer(4, GL_FLOAT, 16, offsetOf(0));
        else
            glVertexPointer(3, GL_FLOAT, sizeof(Vertex), offsetOf(0));
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, way == 8 ? indices : 0);
        if (way == 8)
            glDrawElements(GL_TRIANGLES, kCells * kCells * 6, GL_UNSIGNED_INT, offsetOf(0));
        else
            glDrawArrays(GL_TRIANGLES, 0, kCells * kCells * 6);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

// Nodes examine contents that they draw for the second time. Only the third time is visible.
void drawKnown() {
    drawBuffers();
    drawBuffers();
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    drawBuffers();
}

// A deleted buffer lives on in its vertex array, while a new buffer takes its name.
void drawDeleted(bool isRight) {
    GLuint arrays[2] = {}, buffer = 0;
    glGenVertexArrays(2, arrays);
    for (int i = 0; i < 2; ++i) {
        buffer = bufferOf(GL_ARRAY_BUFFER, kBytes, contents(4 * i, isRight != (i == 1)).data());
        glBindVertexArray(arrays[i]);
        glEnableClientState(GL_VERTEX_ARRAY);
        glVertexPointer(3, GL_FLOAT, sizeof(Vertex), offsetOf(0));
        glBindVertexArray(0);
        if (i == 0) glDeleteBuffers(1, &buffer);
    }
    for (int round = 0; round < 4; ++round)
        for (const GLuint array : arrays) {
            glBindVertexArray(array);
            glColor3ub(255, static_cast<GLubyte>(60 * round), 10);
            glDrawArrays(GL_TRIANGLES, 0, kCells * kCells * 6);
        }
    glBindVertexArray(0);
    glDeleteVertexArrays(2, arrays);
    glDeleteBuffers(1, &buffer);
}

// Vertices of client memory, and of a buffer that gets other contents before each draw. The colours follow the
// positions in one array, or lie in another one. Indices are short, or longer than a record.
void drawStreamed(int frame) {
    glEnableClientState(GL_COLOR_ARRAY);
    const GLuint streamed = bufferOf(GL_ARRAY_BUFFER, kBytes, nullptr, GL_STREAM_DRAW);
    for (int i = 0; i < 9; ++i) {
        std::vector<Vertex> vertices = contents(i, (i + frame) % 3 == 0);
        for (Vertex& v : vertices) v.y = 0.6F * v.y + (i % 2 ? 0.4F : -0.4F);
        const bool isClient = i % 3 != 0;
        glBindBuffer(GL_ARRAY_BUFFER, isClient ? 0 : streamed);
        if (!isClient) glBufferData(GL_ARRAY_BUFFER, kBytes, vertices.data(), GL_STREAM_DRAW);
        glVertexPointer(3, GL_FLOAT, sizeof(Vertex),
                        isClient ? static_cast<const void*>(vertices.data()) : offsetOf(0));
        glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex),
                       isClient ? static_cast<const void*>(vertices[0].colour) : offsetOf(12));
        const auto each = static_cast<GLsizei>(vertices.size());
        if (i % 3 == 1) {
            glDrawArrays(GL_TRIANGLES, 6, each - 6);
            glDrawArrays(GL_TRIANGLE_STRIP, 0, 72);
        }
        std::vector<GLuint> numbers;
        for (GLuint n = 0; n < static_cast<GLuint>(each); ++n) numbers.push_back(n);
        if (i % 3 == 2) {
            glDrawElements(GL_TRIANGLES, each, GL_UNSIGNED_INT, numbers.data());
            for (std::size_t part = 0; part < 4; ++part)
                glDrawElements(GL_TRIANGLES, 90, GL_UNSIGNED_INT, numbers.data() + 180 * part);
        }
        if (i % 3 == 0) {
            glDrawArrays(GL_TRIANGLES, 0, each);
            glDrawElements(GL_TRIANGLES, each / 2 / 3 * 3, GL_UNSIGNED_INT, numbers.data());
        }
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glDeleteBuffers(1, &streamed);
    glDisableClientState(GL_COLOR_ARRAY);
}

void draw(Window&, int frame) {
    glClearColor(0, 0, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glEnableClientState(GL_VERTEX_ARRAY);
    for (int way = 0; way < kWays; ++way) write(way, frame % 2 == 0);
    drawKnown();
    if (frame % 3 == 2) { // in the middle of a frame
        for (int way = 0; way < kWays; ++way) write(way, frame % 2 != 0);
        drawKnown();
    }
    drawDeleted(frame % 2 != 0);
    drawStreamed(frame);
    glDisableClientState(GL_VERTEX_ARRAY);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, WindowSpec{}, setUp, draw); }
