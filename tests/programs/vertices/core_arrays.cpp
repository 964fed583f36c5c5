// Vertex formats of the core profile: separate formats and bindings, integer and double attributes, packed types, BGRA.
// Also half floats, fixed point, several divisors, and a buffer bound to many attributes.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>
#include <string>
#include <vector>

using namespace programs;

namespace {

struct Format {
    enum Kind { Float, Integer, Double } kind;
    GLint size;
    GLenum type;
    GLboolean normalized;
    GLuint elementBytes;
    float scale; // maps the values to 0…1
};

const Format kFormats[] = {
    {Format::Float, 4, GL_BYTE, GL_TRUE, 4, 1},
    {Format::Float, 3, GL_BYTE, GL_FALSE, 4, 0.008F},
    {Format::Float, 4, GL_UNSIGNED_BYTE, GL_TRUE, 4, 1},
    {Format::Float, GL_BGRA, GL_UNSIGNED_BYTE, GL_TRUE, 4, 1},
    {Format::Float, 2, GL_SHORT, GL_TRUE, 4, 1},
    {Format::Float, 4, GL_UNSIGNED_SHORT, GL_TRUE, 8, 1},
    {Format::Float, 3, GL_INT, GL_TRUE, 12, 1},
    {Format::Float, 4, GL_UNSIGNED_INT, GL_TRUE, 16, 1},
    {Format::Float, 4, GL_INT_2_10_10_10_REV, GL_TRUE, 4, 1},
    {Format::Float, 4, GL_UNSIGNED_INT_2_10_10_10_REV, GL_TRUE, 4, 1},
    {Format::Float, GL_BGRA, GL_UNSIGNED_INT_2_10_10_10_REV, GL_TRUE, 4, 1},
    {Format::Float, 3, GL_UNSIGNED_INT_10F_11F_11F_REV, GL_FALSE, 4, 0.001F},
    {Format::Float, 4, GL_FIXED, GL_FALSE, 16, 0.0001F},
    {Format::Float, 1, GL_UNSIGNED_SHORT, GL_FALSE, 2, 0.00001F},
    {Format::Integer, 4, GL_BYTE, GL_FALSE, 4, 0.008F},
    {Format::Integer, 3, GL_UNSIGNED_BYTE, GL_FALSE, 4, 0.004F},
    {Format::Integer, 2, GL_SHORT, GL_FALSE, 4, 0.00003F},
    {Format::Integer, 4, GL_UNSIGNED_SHORT, GL_FALSE, 8, 0.000015F},
    {Format::Integer, 1, GL_INT, GL_FALSE, 4, 4.7e-10F},
};

constexpr GLuint kPlaceBinding = 0, kValueBinding = 3, kInstanceBinding = 5;
GLuint floatProgram, intProgram, doubleProgram, drawProgram;
GLuint vertexArray, buffers[3];
int cellIndex;

std::string vertexSource(const char* type, const char* tint) {
    return std::string("#version 430\n#extension GL_ARB_shader_draw_parameters : require\nlayout(location=0) in vec2 "
                       "place;\n") +
           "layout(location=4) in " + type + " value;\nlayout(location=7) in vec2 shift;\n" +
           "layout(location=0) uniform vec2 offset; layout(location=1) uniform float scale;\n" +
           "out vec4 color;\nvoid main() { color = " + tint + " * scale;\n" +
           "gl_Position = vec4(place + offset + shift, 0, 1); }\n";
}

GLuint makeProgram(const char* type, const char* tint = "vec4(abs(value))") {
    return buildProgram({{GL_VERTEX_SHADER, vertexSource(type, tint).c_str()},
                         {GL_FRAGMENT_SHADER, "#version 430\nin vec4 color; out vec4 result;\n"
                                              "void main() { result = vec4(color.rgb, 1); }\n"}});
}

void useCell(GLuint program, float scale) {
    glUseProgram(program);
    glUniform2f(0, -0.95F + 0.32F * float(cellIndex % 6), -0.95F + 0.38F * float(cellIndex / 6));
    glUniform1f(1, scale);
    ++cellIndex;
}

// Returns bytes that are valid as integers of any size and as half and packed floats.
std::vector<GLubyte> valueBytes(int frame) {
    std::vector<GLubyte> bytes(1024);
    Sequence numbers(unsigned(frame) * 3 + 1);
    for (GLubyte& value : bytes) {
        value = numbers.byte() & 0x7b;
    }
    return bytes;
}

void drawFormats(int frame) {
    const auto bytes = valueBytes(frame);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(bytes.size()), bytes.data(), GL_STREAM_DRAW);
    GLuint offset = 16;
    for (const Format& format : kFormats) {
        const bool integer = format.kind == Format::Integer;
        if (integer) {
            glVertexAttribIFormat(4, format.size, format.type, 0);
        } else {
            glVertexAttribFormat(4, format.size, format.type, format.normalized, 0);
        }
        glBindVertexBuffer(kValueBinding, buffers[1], offset, GLsizei(format.elementBytes + 4));
        offset += 8;
        useCell(integer ? intProgram : floatProgram, format.scale);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 6, 2);
    }
}

void drawHalvesAndDoubles(int frame) {
    GLushort halves[6 * 4];
    GLdouble doubles[6 * 3];
    for (int i = 0; i < 24; ++i) {
        halves[i] = GLushort(0x3000 + i * 97 + frame * 64); // about 0.13 … 0.6
    }
    for (int i = 0; i < 18; ++i) {
        doubles[i] = ((i * 7 + frame * 3) % 11) / 11.0;
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    glBufferSubData(GL_ARRAY_BUFFER, 0, sizeof halves, halves);
    glBufferSubData(GL_ARRAY_BUFFER, 64, sizeof doubles, doubles);
    glVertexAttribFormat(4, 4, GL_HALF_FLOAT, GL_FALSE, 0);
    glBindVertexBuffer(kValueBinding, buffers[1], 0, 8);
    useCell(floatProgram, 1);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 6, 1);
    glVertexAttribLFormat(4, 3, GL_DOUBLE, 0);
    glBindVertexBuffer(kValueBinding, buffers[1], 64, 24);
    useCell(doubleProgram, 1);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 6, 1);
}

// Draws all three attributes from one buffer. The value advances once per two instances.
void drawInterleaved(int frame) {
    struct Vertex {
        GLfloat place[2];
        GLubyte color[4];
    };
    Vertex vertices[8];
    for (int i = 0; i < 8; ++i) {
        vertices[i] = {{float(i / 2) * 0.06F, float(i % 2) * 0.2F},
                       {GLubyte(i * 30), GLubyte(frame * 50), GLubyte(255 - i * 20), 255}};
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    glBufferSubData(GL_ARRAY_BUFFER, 128, sizeof vertices, vertices);
    glVertexAttribFormat(0, 2, GL_FLOAT, GL_FALSE, 0);
    glVertexAttribFormat(4, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Vertex, color));
    glVertexAttribBinding(4, kPlaceBinding);
    glBindVertexBuffer(kPlaceBinding, buffers[1], 128, sizeof(Vertex));
    useCell(floatProgram, 1);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 8, 3);
    glVertexAttribBinding(4, kValueBinding);
    glBindVertexBuffer(kValueBinding, buffers[1], 136, sizeof(Vertex));
    glVertexAttribFormat(4, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0);
    glVertexBindingDivisor(kValueBinding, 2);
    useCell(floatProgram, 1);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 8, 4);
    glVertexBindingDivisor(kValueBinding, 0);
    const GLuint names[] = {buffers[0], buffers[1]};
    const GLintptr offsets[] = {0, 128};
    const GLsizei strides[] = {8, sizeof(Vertex)};
    glBindVertexBuffers(kPlaceBinding, 1, names, offsets, strides);
    glBindVertexBuffers(kValueBinding, 1, names + 1, offsets + 1, strides + 1);
}

// Draws with indices in the program's memory, which Mesa also accepts in core contexts. Each of several draws has its
// number.
void drawUnboundIndices() {
    static const GLushort kFirst[] = {0, 1, 2}, kSecond[] = {3, 4, 5};
    const void* const lists[] = {kFirst, kSecond, kSecond};
    const GLsizei counts[] = {3, 0, 3};
    useCell(drawProgram, 1);
    glMultiDrawElements(GL_TRIANGLES, counts, GL_UNSIGNED_SHORT, lists, 3);
    useCell(floatProgram, 1);
    glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, kSecond);
}

void setUp() {
    floatProgram = makeProgram("vec4");
    intProgram = makeProgram("ivec4");
    doubleProgram = makeProgram("dvec4");
    drawProgram = makeProgram("vec4", "vec4(1, 0.3 + 0.3 * float(gl_DrawIDARB), abs(value.x) * 0.01, 1)");
    glGenBuffers(3, buffers);
    const GLfloat places[] = {0, 0, 0, 0.25F, 0.1F, 0, 0.1F, 0.27F, 0.22F, 0.05F, 0.2F, 0.24F};
    const GLfloat shifts[] = {0, 0, 0.04F, 0.06F, 0.02F, 0.02F, 0, 0.05F};
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, sizeof places, places, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[2]);
    glBufferData(GL_ARRAY_BUFFER, sizeof shifts, shifts, GL_STATIC_DRAW);
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glVertexAttribFormat(0, 2, GL_FLOAT, GL_FALSE, 0);
    glVertexAttribBinding(0, kPlaceBinding);
    glBindVertexBuffer(kPlaceBinding, buffers[0], 0, 8);
    glVertexAttribBinding(4, kValueBinding);
    glVertexAttribFormat(7, 2, GL_FLOAT, GL_FALSE, 0);
    glVertexAttribBinding(7, kInstanceBinding);
    glBindVertexBuffer(kInstanceBinding, buffers[2], 0, 8);
    glVertexBindingDivisor(kInstanceBinding, 1);
    for (const GLuint attribute : {0U, 4U, 7U}) {
        glEnableVertexAttribArray(attribute);
    }
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 5};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.05F, 0.05F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            cellIndex = 0;
            drawFormats(frame);
            drawHalvesAndDoubles(frame);
            drawInterleaved(frame);
            drawUnboundIndices();
            GLint readBack = 0;
            glGetVertexAttribiv(4, GL_VERTEX_ATTRIB_ARRAY_TYPE, &readBack);
            showBits(37, std::uint32_t(readBack));
        });
}
