// Client arrays of the fixed function: all pointers and types, strides, glInterleavedArrays, client memory that changes
// between draws, client arrays with element buffers and the reverse.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>
#include <vector>

using namespace programs;

namespace {

constexpr int kColumns = 8;
int cellIndex;

void enterCell() {
    glLoadIdentity();
    glTranslatef(float(4 + (cellIndex % kColumns) * 30), float(4 + (cellIndex / kColumns) * 20), 0);
    ++cellIndex;
}

// Returns twelve vertices of a zigzag band in any type, `stride` bytes apart.
template <class T> std::vector<std::uint8_t> band(int components, std::size_t stride, int frame) {
    std::vector<std::uint8_t> bytes(stride * 12 + 64, 0xcd);
    for (int i = 0; i < 12; ++i) {
        T values[4] = {static_cast<T>(i * 2), static_cast<T>((i % 2) * 12 + (i * frame) % 3), T(0), T(1)};
        std::memcpy(&bytes[stride * std::size_t(i)], values, sizeof(T) * std::size_t(components));
    }
    return bytes;
}

std::vector<GLubyte> colors(int frame) {
    std::vector<GLubyte> bytes(12 * 4);
    Sequence numbers(unsigned(frame) + 31);
    for (GLubyte& value : bytes) {
        value = numbers.byte();
    }
    return bytes;
}

template <class T> void drawVertexType(GLenum type, int frame) {
    for (int components = 2; components <= 4; ++components) {
        const std::size_t packed = sizeof(T) * std::size_t(components);
        // Tightly packed by stride 0, or padded by an odd number of elements.
        const std::size_t stride = components == 3 ? packed + 3 * sizeof(T) : packed;
        const auto places = band<T>(components, stride, frame);
        enterCell();
        glVertexPointer(components, type, components == 3 ? GLsizei(stride) : 0, places.data());
        glDrawArrays(GL_TRIANGLE_STRIP, components - 2, 10);
    }
}

void drawVertexTypes(int frame) {
    const auto palette = colors(frame);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glColorPointer(4, GL_UNSIGNED_BYTE, 0, palette.data());
    drawVertexType<GLshort>(GL_SHORT, frame);
    drawVertexType<GLint>(GL_INT, frame);
    drawVertexType<GLfloat>(GL_FLOAT, frame);
    drawVertexType<GLdouble>(GL_DOUBLE, frame);
    // Half floats and signed packed positions.
    const GLushort one = 0x3c00;
    const GLushort halves[6] = {0, 0, GLushort(one + 0x1000), 0, one, GLushort(one + 0x0c00)};
    enterCell();
    glScalef(2, 2, 1);
    glVertexPointer(2, GL_HALF_FLOAT, 0, halves);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const GLuint w = 1U << 30;
    const GLuint packed[3] = {w, 20 | w, 10U | (14U << 10) | w};
    enterCell();
    glVertexPointer(4, GL_INT_2_10_10_10_REV, 0, packed);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisableClientState(GL_COLOR_ARRAY);
    glDisableClientState(GL_VERTEX_ARRAY);
}

template <class T> void drawColorType(GLint size, GLenum type, double full, int frame) {
    std::vector<T> values(12 * 4);
    Sequence numbers(type + unsigned(frame));
    for (T& value : values) {
        value = static_cast<T>(double(numbers.unit()) * full);
    }
    enterCell();
    glColorPointer(size, type, GLsizei(sizeof(T) * 4), values.data());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
}

void drawColorTypes(int frame) {
    const auto places = band<GLfloat>(2, 8, frame);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glVertexPointer(2, GL_FLOAT, 8, places.data());
    drawColorType<GLbyte>(3, GL_BYTE, 127, frame);
    drawColorType<GLubyte>(4, GL_UNSIGNED_BYTE, 255, frame);
    drawColorType<GLshort>(3, GL_SHORT, 32767, frame);
    drawColorType<GLushort>(4, GL_UNSIGNED_SHORT, 65535, frame);
    drawColorType<GLint>(3, GL_INT, 2147483647, frame);
    drawColorType<GLuint>(4, GL_UNSIGNED_INT, 4294967295.0, frame);
    drawColorType<GLfloat>(3, GL_FLOAT, 1, frame);
    drawColorType<GLdouble>(4, GL_DOUBLE, 1, frame);
    drawColorType<GLubyte>(GL_BGRA, GL_UNSIGNED_BYTE, 255, frame);
    drawColorType<GLuint>(GL_BGRA, GL_UNSIGNED_INT_2_10_10_10_REV, 4294967295.0, frame);
    glDisableClientState(GL_COLOR_ARRAY);
    // Secondary colours and fog coordinates.
    glEnable(GL_COLOR_SUM);
    glEnableClientState(GL_SECONDARY_COLOR_ARRAY);
    const auto palette = colors(frame + 3);
    glSecondaryColorPointer(3, GL_UNSIGNED_BYTE, 4, palette.data());
    glColor3f(0.2F, 0, 0);
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
    glDisableClientState(GL_SECONDARY_COLOR_ARRAY);
    glDisable(GL_COLOR_SUM);
    GLdouble distances[12];
    for (int i = 0; i < 12; ++i) {
        distances[i] = i * 0.08;
    }
    glFogi(GL_FOG_COORD_SRC, GL_FOG_COORD);
    glFogi(GL_FOG_MODE, GL_LINEAR);
    glEnable(GL_FOG);
    glEnableClientState(GL_FOG_COORD_ARRAY);
    glFogCoordPointer(GL_DOUBLE, 0, distances);
    glColor3f(1, 1, 0);
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
    glDisableClientState(GL_FOG_COORD_ARRAY);
    glDisable(GL_FOG);
    glDisableClientState(GL_VERTEX_ARRAY);
}

void drawNormalsAndEdges(int frame) {
    const auto places = band<GLfloat>(2, 8, frame);
    GLbyte normals[12 * 3];
    GLboolean edges[12];
    Sequence numbers(unsigned(frame) + 2);
    for (GLbyte& value : normals) {
        value = GLbyte(numbers.byte() % 120);
    }
    for (GLboolean& edge : edges) {
        edge = numbers.byte() % 2 == 0 ? GL_TRUE : GL_FALSE;
    }
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_FLOAT, 8, places.data());
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_NORMALIZE);
    glEnableClientState(GL_NORMAL_ARRAY);
    glNormalPointer(GL_BYTE, 3, normals);
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
    glDisableClientState(GL_NORMAL_ARRAY);
    glDisable(GL_LIGHTING);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glEnableClientState(GL_EDGE_FLAG_ARRAY);
    glEdgeFlagPointer(1, edges);
    glColor3f(0.4F, 1, 0.4F);
    enterCell();
    glDrawArrays(GL_TRIANGLES, 0, 12);
    glDisableClientState(GL_EDGE_FLAG_ARRAY);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisableClientState(GL_VERTEX_ARRAY);
}

void drawTextured(int frame) {
    const auto places = band<GLint>(2, 8, frame);
    GLshort first[12 * 2];
    GLfloat second[12 * 3];
    for (int i = 0; i < 12; ++i) {
        first[i * 2] = GLshort(i);
        first[i * 2 + 1] = GLshort(i % 3);
        second[i * 3] = float(i) * 0.3F;
        second[i * 3 + 1] = float(frame) * 0.2F;
        second[i * 3 + 2] = 0;
    }
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_INT, 0, places.data());
    glEnable(GL_TEXTURE_2D);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glTexCoordPointer(2, GL_SHORT, 0, first);
    glColor3f(1, 1, 1);
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
    glClientActiveTexture(GL_TEXTURE1);
    glActiveTexture(GL_TEXTURE1);
    glEnable(GL_TEXTURE_2D);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glTexCoordPointer(3, GL_FLOAT, 0, second);
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
    glDisable(GL_TEXTURE_2D);
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    glClientActiveTexture(GL_TEXTURE0);
    glActiveTexture(GL_TEXTURE0);
    glDisable(GL_TEXTURE_2D);
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    glDisableClientState(GL_VERTEX_ARRAY);
}

void drawInterleaved(int frame) {
    struct Packed {
        GLubyte color[4];
        GLfloat place[3];
    };
    Packed vertices[6];
    GLfloat wide[6 * 15];
    Sequence numbers(unsigned(frame) + 77);
    for (int i = 0; i < 6; ++i) {
        vertices[i] = {{numbers.byte(), numbers.byte(), numbers.byte(), 255}, {float(i * 4), float(i % 2 * 13), 0}};
        // GL_T4F_C4F_N3F_V4F
        const GLfloat one[15] = {float(i),
                                 0.3F,
                                 0,
                                 1,
                                 numbers.unit(),
                                 numbers.unit(),
                                 0.5F,
                                 1,
                                 0,
                                 0,
                                 1,
                                 float(i * 4),
                                 float(i % 2 * 10 + frame),
                                 0,
                                 1};
        std::memcpy(wide + i * 15, one, sizeof one);
    }
    enterCell();
    glInterleavedArrays(GL_C4UB_V3F, 0, vertices);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 6);
    enterCell();
    glInterleavedArrays(GL_T4F_C4F_N3F_V4F, 0, wide);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 6);
    enterCell();
    glInterleavedArrays(GL_V2F, 60, wide + 11);
    glColor3f(1, 0.5F, 0);
    glDrawArrays(GL_LINE_STRIP, 1, 4);
    glDisableClientState(GL_VERTEX_ARRAY);
}

// Draws from the same pointer, with other contents in each draw.
void drawAnimated(int frame) {
    static GLfloat places[6];
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, places);
    for (int step = 0; step < 3; ++step) {
        const GLfloat now[6] = {0, 0, 20, float(step * 3 + frame), float(step * 6), 14};
        std::memcpy(places, now, sizeof now);
        glColor3f(0.3F * float(step), 1, 0.5F);
        enterCell();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    // One of the draws uses glArrayElement, with memory changed between the vertices.
    enterCell();
    glBegin(GL_TRIANGLES);
    glArrayElement(0);
    places[2] = 10;
    glArrayElement(1);
    places[4] = 5;
    places[5] = 7;
    glArrayElement(2);
    glEnd();
    glDisableClientState(GL_VERTEX_ARRAY);
}

// Element 6 starts a new strip; as a vertex it would be far away.
void drawElementsAgain() {
    static const GLfloat places[] = {0, 0, 6, 14, 8, 2, 12, 0, 16, 14, 20, 2, 20, 20};
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, places);
    glEnable(GL_PRIMITIVE_RESTART);
    glPrimitiveRestartIndex(6);
    glColor3f(0.2F, 0.9F, 0.9F);
    enterCell();
    glBegin(GL_TRIANGLE_STRIP);
    for (const GLint element : {0, 1, 2, 6, 3, 4, 5}) {
        glArrayElement(element);
    }
    glEnd();
    glDisable(GL_PRIMITIVE_RESTART);
    glDisableClientState(GL_VERTEX_ARRAY);
}

void drawMixedWithBuffers(int frame) {
    GLuint buffers[2];
    glGenBuffers(2, buffers);
    const auto places = band<GLfloat>(2, 8, frame);
    const GLushort order[] = {2, 3, 4, 3, 4, 5, 8, 9, 10};
    const auto palette = colors(frame + 9);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    // Client vertices, indices from a buffer.
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof order, order, GL_STATIC_DRAW);
    glVertexPointer(2, GL_FLOAT, 0, places.data());
    glColorPointer(4, GL_UNSIGNED_BYTE, 0, palette.data());
    enterCell();
    glDrawElements(GL_TRIANGLES, 9, GL_UNSIGNED_SHORT, nullptr);
    enterCell();
    glDrawRangeElements(GL_TRIANGLES, 3, 10, 6, GL_UNSIGNED_SHORT, reinterpret_cast<void*>(6));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    // Vertices from a buffer, colours and indices from memory.
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ARRAY_BUFFER, 96, places.data(), GL_STATIC_DRAW);
    glVertexPointer(2, GL_FLOAT, 0, nullptr);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    enterCell();
    glDrawElements(GL_TRIANGLES, 9, GL_UNSIGNED_SHORT, order);
    const GLubyte small[] = {1, 2, 3, 5, 6, 7};
    const GLuint large[] = {0, 1, 2, 9, 10, 11};
    enterCell();
    glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_BYTE, small);
    glDrawElements(GL_LINES, 6, GL_UNSIGNED_INT, large);
    glDisableClientState(GL_COLOR_ARRAY);
    glDisableClientState(GL_VERTEX_ARRAY);
    glDeleteBuffers(2, buffers);
}

// Reads the same memory in another format from then on. Its vertices keep their positions.
void drawReformatted(int frame) {
    const auto places = band<GLfloat>(4, 16, frame);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, places.data());
    glEnableVertexAttribArray(0);
    glColor3f(0.9F, 0.4F, 0.7F);
    for (const GLuint relative : {0U, 16U}) {
        glVertexAttribFormat(0, 1, GL_FLOAT, GL_FALSE, relative); // only x
        enterCell();
        glDrawArrays(GL_LINE_STRIP, 0, 11);
        glVertexArrayAttribFormat(0, 0, 2, GL_FLOAT, GL_FALSE, relative);
        glDrawArrays(GL_LINE_STRIP, 0, 6);
    }
    glDisableVertexAttribArray(0);
}

// Moves an array to a binding without a buffer: it keeps its address, and takes the stride of the binding.
void drawRebound(int frame) {
    const auto places = band<GLfloat>(4, 16, frame);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 16, places.data());
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(5, 2, GL_FLOAT, GL_FALSE, 32, places.data() + 1);
    glColor3f(0.4F, 0.9F, 0.7F);
    enterCell();
    glVertexAttribBinding(0, 5);
    glDrawArrays(GL_LINE_STRIP, 0, 6);
    enterCell();
    glVertexArrayAttribBinding(0, 0, 0);
    glDrawArrays(GL_LINE_STRIP, 0, 12);
    glDisableVertexAttribArray(0);
}

void drawAfterPoppedClientState(int frame) {
    const auto places = band<GLfloat>(2, 8, frame);
    const auto others = band<GLshort>(2, 4, frame + 1);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, places.data());
    glPushClientAttrib(GL_CLIENT_VERTEX_ARRAY_BIT | GL_CLIENT_PIXEL_STORE_BIT);
    glVertexPointer(2, GL_SHORT, 0, others.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glColor3f(0.5F, 0.5F, 1);
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
    glDisableClientState(GL_VERTEX_ARRAY);
    glPopClientAttrib();
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
    glDisableClientState(GL_VERTEX_ARRAY);
    GLint alignment = 0;
    glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment);
    showBits(37, std::uint32_t(alignment));
}

// Draws with a negative first vertex, so that memory before the array is read.
void drawFromBefore(int frame) {
    const auto places = band<GLfloat>(2, 8, frame);
    const auto palette = colors(frame);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, &places[8 * 4]);
    glColorPointer(4, GL_UNSIGNED_BYTE, 0, &palette[4 * 4]);
    const GLint firsts[] = {-4, 3};
    const GLsizei counts[] = {6, 4};
    enterCell();
    glMultiDrawArrays(GL_TRIANGLE_STRIP, firsts, counts, 2);
    const GLubyte order[] = {1, 2, 3, 4, 5, 6};
    enterCell();
    glDrawElementsBaseVertex(GL_TRIANGLE_STRIP, 6, GL_UNSIGNED_BYTE, order, -4);
    enterCell();
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, -1000000000, 6, 2); // an error
    showBits(38, glGetError());
    glDisableClientState(GL_COLOR_ARRAY);
    glDisableClientState(GL_VERTEX_ARRAY);
}

// Switches arrays through the name of their object. 0 is the object whose arrays may lie in the program's memory.
void drawSwitchedByName(int frame) {
    const auto places = band<GLfloat>(4, 16, frame);
    const auto palette = colors(frame);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, places.data());
    glVertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0, palette.data()); // 3: the colour's alias
    glColor3f(0.3F, 0.9F, 0.5F);
    glEnableVertexArrayAttrib(0, 0);
    glEnableVertexArrayAttrib(0, 3);
    enterCell();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 12);
    glDisableVertexArrayAttrib(0, 3);
    enterCell();
    glDrawArrays(GL_LINE_STRIP, 0, 12);
    glDisableVertexArrayAttrib(0, 0);
}

void makeTextures() {
    GLubyte texels[4 * 4 * 3];
    Sequence numbers(8);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    for (const GLenum unit : {GL_TEXTURE1, GL_TEXTURE0}) {
        GLuint name = 0;
        glGenTextures(1, &name);
        glActiveTexture(unit);
        glBindTexture(GL_TEXTURE_2D, name);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, 4, 4, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
        texels[0] = 255;
        texels[7] = 0;
    }
}

// Moves arrays of object 0 from memory to a buffer, or gives them a divisor, by name. Rejected calls move none.
void drawMovedByName(int frame) {
    const auto y = static_cast<GLfloat>(frame);
    const GLfloat before[] = {0, 0, 12, 0, 6, 9}, after[] = {14, y, 26, y, 20, 9};
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof after, after, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    enterCell();
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, before);
    glVertexArrayVertexBuffer(0, 0, buffer, 0, -1);
    if (glGetError() != GL_INVALID_VALUE) fail("a stride below 0 is no error");
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const GLintptr offset = 0;
    const GLsizei stride = 2 * sizeof(GLfloat);
    if (frame % 2 == 0)
        glVertexArrayVertexBuffer(0, 0, buffer, offset, stride);
    else
        glVertexArrayVertexBuffers(0, 0, 1, &buffer, &offset, &stride);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDeleteBuffers(1, &buffer);
    enterCell();
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, after);
    if (frame % 2 == 0)
        glVertexArrayBindingDivisor(0, 0, 1);
    else
        glVertexBindingDivisor(0, 1);
    glPointSize(4);
    glDrawArraysInstanced(GL_POINTS, 0, 1, 3);
    glPointSize(1);
    glVertexAttribDivisor(0, 0);
    glDisableVertexAttribArray(0);
}

// Uses attribute 0 as the vertex, then not: a shader computes the raster position after the draws. While Mesa has seen
// few changes of arrays, empty draws bring it into a state in which this never ends.
void setRasterPosition() {
    const GLuint program = buildProgram({{GL_VERTEX_SHADER, "#version 110\nattribute vec4 place, second, third;\nvoid "
                                                            "main() { gl_Position = place + second + third; }\n"}},
                                        [](unsigned its) {
                                            glBindAttribLocation(its, 0, "place");
                                            glBindAttribLocation(its, 1, "second");
                                            glBindAttribLocation(its, 2, "third");
                                        });
    static const GLfloat values[24] = {};
    for (GLuint i = 0; i < 3; ++i) {
        glVertexAttribPointer(i, 4, GL_FLOAT, GL_FALSE, 0, values + 4 * i);
        glEnableVertexAttribArray(i);
    }
    glVertexPointer(2, GL_FLOAT, 0, values + 6);
    glEnableClientState(GL_VERTEX_ARRAY);
    glUseProgram(program);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisableVertexAttribArray(0);
    glRasterPos3f(0.25F, 0.25F, 0.5F);
    glUseProgram(0);
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableVertexAttribArray(1);
    glDisableVertexAttribArray(2);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {},
        [](Window&) {
            setRasterPosition();
            makeTextures();
        },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.05F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            glMatrixMode(GL_MODELVIEW);
            cellIndex = 0;
            glColor3f(0.7F, 0.8F, 0.9F);
            drawVertexTypes(frame);
            drawColorTypes(frame);
            drawNormalsAndEdges(frame);
            drawTextured(frame);
            drawInterleaved(frame);
            drawAnimated(frame);
            drawElementsAgain();
            drawMixedWithBuffers(frame);
            drawAfterPoppedClientState(frame);
            drawReformatted(frame);
            drawRebound(frame);
            drawFromBefore(frame);
            drawSwitchedByName(frame);
            drawMovedByName(frame);
        });
}
