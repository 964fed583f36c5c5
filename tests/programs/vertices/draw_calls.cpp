// Every draw command, with client arrays and with buffers: ranges, multi draws, instances, divisors, base vertices and
// instances, primitive restart, indirect draws, vertex array objects.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr GLuint kPlace = 0, kColor = 1, kShift = 2;
constexpr int kVertices = 24;
GLuint program, vertexArray, emptyArray;
GLuint buffers[4]; // positions, indices, indirect commands, shifts
GLint offsetUniform;
int cellIndex;

std::vector<GLfloat> makePlaces(int frame) {
    std::vector<GLfloat> places;
    for (int i = 0; i < kVertices; ++i) {
        places.push_back(float(i / 2) * 0.018F);
        places.push_back(float(i % 2) * 0.14F + float((i * frame) % 5) * 0.01F);
    }
    return places;
}

std::vector<GLubyte> makeColors(int frame) {
    std::vector<GLubyte> colors(kVertices * 4);
    Sequence numbers(unsigned(frame) + 5);
    for (GLubyte& value : colors) {
        value = numbers.byte();
    }
    return colors;
}

void enterCell() {
    glUniform2f(offsetUniform, -0.97F + 0.24F * float(cellIndex % 8), -0.97F + 0.22F * float(cellIndex / 8));
    ++cellIndex;
}

const GLushort kOrder[] = {0, 1, 2, 3, 4, 0xffff, 6, 7, 8, 9, 10, 11, 0xffff, 14, 15, 16, 17};
constexpr GLsizei kOrderCount = 17;
const GLubyte kBytes[] = {0, 1, 2, 3, 6, 7, 8};
const GLuint kInts[] = {0, 1, 2, 0xffffffffU, 5, 6, 7, 8};

const void* at(std::size_t offset) { return reinterpret_cast<const void*>(offset); }

// Draws with indices. `base` is null for a bound element buffer that holds kOrder, kBytes, kInts at 0, 64, 96.
void drawIndexed(bool fromBuffer) {
    const void* order = fromBuffer ? at(0) : kOrder;
    const void* bytes = fromBuffer ? at(64) : kBytes;
    const void* ints = fromBuffer ? at(96) : kInts;
    glEnable(GL_PRIMITIVE_RESTART);
    glPrimitiveRestartIndex(0xffff);
    enterCell();
    glDrawElements(GL_TRIANGLE_STRIP, kOrderCount, GL_UNSIGNED_SHORT, order);
    enterCell();
    glDrawElementsInstanced(GL_TRIANGLE_STRIP, kOrderCount, GL_UNSIGNED_SHORT, order, 3);
    glDisable(GL_PRIMITIVE_RESTART);
    glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
    enterCell();
    glDrawElements(GL_LINE_STRIP, 8, GL_UNSIGNED_INT, ints);
    glDisable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
    enterCell();
    glDrawElementsBaseVertex(GL_TRIANGLE_STRIP, 7, GL_UNSIGNED_BYTE, bytes, 9);
    enterCell();
    glDrawRangeElements(GL_TRIANGLES, 0, 8, 6, GL_UNSIGNED_BYTE, bytes);
    glDrawRangeElementsBaseVertex(GL_LINES, 0, 8, 6, GL_UNSIGNED_BYTE, bytes, 12);
    enterCell();
    glDrawElementsInstancedBaseVertex(GL_TRIANGLE_STRIP, 7, GL_UNSIGNED_BYTE, bytes, 4, 5);
    enterCell();
    glDrawElementsInstancedBaseInstance(GL_TRIANGLE_STRIP, 7, GL_UNSIGNED_BYTE, bytes, 2, 3);
    enterCell();
    glDrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLE_STRIP, 7, GL_UNSIGNED_BYTE, bytes, 3, 10, 1);
}

void drawMultiple(bool fromBuffer) {
    const GLint firsts[] = {0, 8, 14};
    const GLsizei counts[] = {6, 4, 9};
    enterCell();
    glMultiDrawArrays(GL_TRIANGLE_STRIP, firsts, counts, 3);
    const auto* orderBytes = reinterpret_cast<const GLubyte*>(kOrder);
    const void* starts[] = {fromBuffer ? at(0) : orderBytes, fromBuffer ? at(12) : orderBytes + 12};
    const GLsizei indexCounts[] = {5, 6};
    const GLint bases[] = {0, 7};
    enterCell();
    glMultiDrawElements(GL_TRIANGLE_STRIP, indexCounts, GL_UNSIGNED_SHORT, starts, 2);
    enterCell();
    glMultiDrawElementsBaseVertex(GL_TRIANGLE_STRIP, indexCounts, GL_UNSIGNED_SHORT, starts, 2, bases);
    const GLenum modes[][2] = {{GL_TRIANGLE_STRIP, 0}, {GL_LINES, 0}, {GL_TRIANGLES, 0}};
    enterCell();
    glMultiModeDrawArraysIBM(modes[0], firsts, counts, 3, sizeof modes[0]);
    enterCell();
    glMultiModeDrawElementsIBM(modes[0], indexCounts, GL_UNSIGNED_SHORT, starts, 2, sizeof modes[0]);
}

void drawPlain() {
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 3, 15);
    enterCell();
    glDrawArraysInstanced(GL_TRIANGLES, 0, 12, 3);
    enterCell();
    glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 2, 9, 2, 4);
}

void drawIndirect() {
    enterCell();
    glDrawArraysIndirect(GL_TRIANGLE_STRIP, at(0));
    enterCell();
    glDrawElementsIndirect(GL_TRIANGLE_STRIP, GL_UNSIGNED_BYTE, at(32));
    enterCell();
    glMultiDrawArraysIndirect(GL_TRIANGLE_STRIP, at(64), 2, 0);
    enterCell();
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, at(96), 2, 32);
}

void drawFromClientMemory(int frame) {
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    const auto places = makePlaces(frame);
    const auto colors = makeColors(frame);
    GLfloat shifts[16];
    for (int i = 0; i < 16; ++i) {
        shifts[i] = float(i % 2 == 0 ? i : -i) * 0.006F;
    }
    glVertexAttribPointer(kPlace, 2, GL_FLOAT, GL_FALSE, 0, places.data());
    glVertexAttribPointer(kColor, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0, colors.data());
    glVertexAttribPointer(kShift, 2, GL_FLOAT, GL_FALSE, 0, shifts);
    glVertexAttribDivisor(kShift, 1);
    for (const GLuint attribute : {kPlace, kColor, kShift}) {
        glEnableVertexAttribArray(attribute);
    }
    drawPlain();
    drawIndexed(false);
    drawMultiple(false);
    // An indirect command in client memory, as the compatibility profile allows.
    const GLuint command[] = {9, 2, 1, 1};
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    glBindVertexArray(vertexArray);
    enterCell();
    glDrawArraysIndirect(GL_TRIANGLE_STRIP, command);
    glBindVertexArray(0);
    for (const GLuint attribute : {kPlace, kColor, kShift}) {
        glDisableVertexAttribArray(attribute);
    }
    glVertexAttribDivisor(kShift, 0);
}

void drawFromBuffers(int frame) {
    glBindVertexArray(vertexArray);
    const auto places = makePlaces(frame + 1);
    const auto colors = makeColors(frame + 1);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(places.size() * 4), places.data());
    glBufferSubData(GL_ARRAY_BUFFER, kVertices * 8, kVertices * 4, colors.data());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffers[2]);
    drawPlain();
    drawIndexed(true);
    drawMultiple(true);
    drawIndirect();
    // Another vertex array object with constant colours.
    glBindVertexArray(emptyArray);
    glVertexAttrib4f(kColor, 0.2F, float(frame) * 0.2F, 1, 1);
    glVertexAttrib2f(kShift, 0, 0);
    enterCell();
    glDrawArrays(GL_TRIANGLES, 0, 12);
    glBindVertexArray(0);
}

void makeBuffers() {
    glGenBuffers(4, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, kVertices * 12, nullptr, GL_DYNAMIC_DRAW);
    const GLuint commands[] = {
        9, 3, 2,  0, 0, 0, 0,  0, // arrays: count, instances, first, base instance
        7, 2, 64, 5, 1, 0, 0,  0, // elements as bytes: count, instances, first index, base vertex
        6, 1, 0,  0, 6, 2, 10, 1, // two array commands
        3, 1, 0,  0, 0, 0, 0,  0, // two element commands, 32 bytes apart
        6, 2, 6,  3, 0, 0, 0,  0};
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffers[2]);
    glBufferData(GL_DRAW_INDIRECT_BUFFER, sizeof commands, commands, GL_STATIC_DRAW);
    GLfloat shifts[16];
    for (int i = 0; i < 16; ++i) {
        shifts[i] = float(i) * 0.005F;
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffers[3]);
    glBufferData(GL_ARRAY_BUFFER, sizeof shifts, shifts, GL_STATIC_DRAW);
}

void makeVertexArrays() {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, 128, nullptr, GL_STATIC_DRAW);
    glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0, sizeof kOrder, kOrder);
    glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 64, sizeof kBytes, kBytes);
    glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 96, sizeof kInts, kInts);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glVertexAttribPointer(kPlace, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glVertexAttribPointer(kColor, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0, at(kVertices * 8));
    glBindBuffer(GL_ARRAY_BUFFER, buffers[3]);
    glVertexAttribPointer(kShift, 2, GL_FLOAT, GL_FALSE, 8, nullptr);
    glVertexAttribDivisor(kShift, 1);
    for (const GLuint attribute : {kPlace, kColor, kShift}) {
        glEnableVertexAttribArray(attribute);
    }
    glGenVertexArrays(1, &emptyArray);
    glBindVertexArray(emptyArray);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glVertexAttribPointer(kPlace, 2, GL_FLOAT, GL_FALSE, 16, at(8));
    glEnableVertexAttribArray(kPlace);
    glBindVertexArray(0);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Compatibility, 4, 3};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            program = buildProgram(
                {{GL_VERTEX_SHADER, "#version 330\nlayout(location=0) in vec2 place; layout(location=1) in vec4 tint;\n"
                                    "layout(location=2) in vec2 shift; uniform vec2 offset; flat out vec4 color;\n"
                                    "void main() { color = tint * (1.0 - 0.2 * float(gl_InstanceID));\n"
                                    "gl_Position = vec4(place + offset + shift, 0, 1); }\n"},
                 {GL_FRAGMENT_SHADER, "#version 330\nflat in vec4 color; out vec4 result;\n"
                                      "void main() { result = vec4(color.rgb, 1); }\n"}});
            offsetUniform = glGetUniformLocation(program, "offset");
            makeBuffers();
            makeVertexArrays();
        },
        [](Window&, int frame) {
            glClearColor(0.15F, 0.1F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            glUseProgram(program);
            cellIndex = 0;
            drawFromClientMemory(frame);
            drawFromBuffers(frame);
            glUseProgram(0);
        });
}
