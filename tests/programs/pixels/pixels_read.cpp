// glReadPixels in many formats, types and pack states, into memory and pixel buffers, of colour, depth and stencil,
// inside and across the window's edge. The pixels read are drawn again, so that a wrong byte is a wrong pixel.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

using namespace programs;

namespace {

int cellIndex;

void drawScene(Window& window, unsigned frame) {
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_STENCIL_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    glStencilFunc(GL_ALWAYS, 0, 0xff);
    glBegin(GL_TRIANGLES);
    Sequence numbers(frame + 40);
    for (int i = 0; i < 45; ++i) {
        glColor4f(numbers.unit(), numbers.unit(), numbers.unit(), numbers.unit());
        glVertex3f(numbers.unit() * float(window.width()), numbers.unit() * float(window.height()) * 0.5F,
                   numbers.unit() * 1.8F - 0.9F);
    }
    glEnd();
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_DEPTH_TEST);
}

// Moves to the cell for the next result: rows of cells in the upper half.
void enterCell(Window& window) {
    glWindowPos2i(2 + (cellIndex % 8) * 31, window.height() / 2 + 2 + (cellIndex / 8) * 17);
    ++cellIndex;
}

constexpr int kWidth = 27, kHeight = 13;

void readFormats(Window& window, unsigned frame) {
    const GLenum kinds[][2] = {{GL_RGB, GL_UNSIGNED_BYTE},
                               {GL_RGBA, GL_UNSIGNED_BYTE},
                               {GL_BGRA, GL_UNSIGNED_BYTE},
                               {GL_BGR, GL_UNSIGNED_BYTE},
                               {GL_RED, GL_UNSIGNED_BYTE},
                               {GL_GREEN, GL_UNSIGNED_SHORT},
                               {GL_LUMINANCE, GL_UNSIGNED_BYTE},
                               {GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE},
                               {GL_RGB, GL_FLOAT},
                               {GL_RGBA, GL_UNSIGNED_SHORT},
                               {GL_RGB, GL_SHORT},
                               {GL_RGBA, GL_INT},
                               {GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV},
                               {GL_RGB, GL_UNSIGNED_SHORT_5_6_5},
                               {GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4},
                               {GL_RGB, GL_HALF_FLOAT},
                               {GL_ALPHA, GL_UNSIGNED_BYTE}};
    const int x = 5 + int(frame) * 2;
    int y = 1;
    for (const auto& kind : kinds) {
        std::vector<GLubyte> pixels(kWidth * kHeight * 16 + 64, 0x55);
        glReadPixels(x, y, kWidth, kHeight, kind[0], kind[1], pixels.data());
        enterCell(window);
        glDrawPixels(kWidth, kHeight, kind[0], kind[1], pixels.data());
        y += 3;
    }
}

void readWithPackState(Window& window, unsigned frame) {
    std::vector<GLubyte> pixels(40 * 3 * 20, GLubyte(30 + frame * 20));
    glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, 37);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 5);
    glPixelStorei(GL_PACK_SKIP_ROWS, 2);
    glReadPixels(20, 10, 22, 9, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 37);
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    // Swapped bytes appear as other colours.
    glPixelStorei(GL_PACK_SWAP_BYTES, GL_TRUE);
    std::vector<GLubyte> wide(40 * 6 * 20, 0);
    glReadPixels(20, 30, 22, 9, GL_RGB, GL_UNSIGNED_SHORT, wide.data());
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_RGB, GL_UNSIGNED_SHORT, wide.data());
    glPopClientAttrib();
}

// Reads across the window's edges: the memory of pixels outside is unchanged.
void readAcrossEdges(Window& window, unsigned frame) {
    std::vector<GLubyte> pixels(kWidth * kHeight * 4, 0x80);
    glReadPixels(-8, -4, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    std::vector<GLubyte> others(kWidth * kHeight * 4, 0x40);
    glReadPixels(window.width() - 12, 5 + int(frame), kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, others.data());
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, others.data());
}

void readIntoBuffer(Window& window, unsigned frame) {
    GLuint buffers[2];
    glGenBuffers(2, buffers);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[0]);
    glBufferData(GL_PIXEL_PACK_BUFFER, kWidth * kHeight * 4 + 64, nullptr, GL_STREAM_READ);
    glReadPixels(40 + int(frame), 6, kWidth, kHeight, GL_BGRA, GL_UNSIGNED_BYTE, reinterpret_cast<void*>(64));
    // Drawn directly from the buffer, and mapped and drawn from memory.
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffers[0]);
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_BGRA, GL_UNSIGNED_BYTE, reinterpret_cast<void*>(64));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    const auto* mapped = static_cast<const GLubyte*>(glMapBuffer(GL_PIXEL_PACK_BUFFER, GL_READ_ONLY));
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, mapped + 64);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    std::vector<GLubyte> copy(kWidth * kHeight * 4);
    glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 64, GLsizeiptr(copy.size()), copy.data());
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_BGRA, GL_UNSIGNED_BYTE, copy.data());
    glDeleteBuffers(2, buffers);
}

void readDepthAndStencil(Window& window, unsigned frame) {
    const int x = 60 - int(frame) * 5;
    std::vector<GLfloat> depths(kWidth * kHeight);
    glReadPixels(x, 20, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_LUMINANCE, GL_FLOAT, depths.data());
    std::vector<GLuint> deep(kWidth * kHeight);
    glReadPixels(x, 20, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, deep.data());
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_RGBA, GL_UNSIGNED_INT_8_8_8_8, deep.data());
    std::vector<GLushort> shallow((kWidth + 1) * kHeight);
    glReadPixels(x, 20, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, shallow.data());
    enterCell(window);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, kWidth + 1);
    glDrawPixels(kWidth, kHeight, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, shallow.data());
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    std::vector<GLubyte> stencils(32 * kHeight);
    glPixelTransferi(GL_INDEX_SHIFT, 4);
    glReadPixels(x, 5, kWidth, kHeight, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencils.data());
    glPixelTransferi(GL_INDEX_SHIFT, 0);
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_LUMINANCE, GL_UNSIGNED_BYTE, stencils.data());
    std::vector<GLuint> both(kWidth * kHeight);
    glReadPixels(x, 5, kWidth, kHeight, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, both.data());
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, both.data());
}

void readTransferred(Window& window) {
    std::vector<GLubyte> pixels(kWidth * kHeight * 4);
    glPixelTransferf(GL_RED_SCALE, 0.5F);
    glPixelTransferf(GL_BLUE_BIAS, 0.25F);
    glReadPixels(70, 12, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glPixelTransferf(GL_RED_SCALE, 1);
    glPixelTransferf(GL_BLUE_BIAS, 0);
    enterCell(window);
    glDrawPixels(kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

// Reads state that is packed like images. The nodes draw from the buffer that received it.
void readState(Window& window, unsigned frame) {
    const auto* mapAt = reinterpret_cast<const void*>(256);
    GLubyte pattern[128], solid[128];
    Sequence numbers(frame + 9);
    for (GLubyte& byte : pattern) byte = numbers.byte();
    std::fill(std::begin(solid), std::end(solid), GLubyte(0xff));
    GLfloat values[32];
    for (GLfloat& value : values) value = numbers.unit();
    glPolygonStipple(pattern);
    glPixelMapfv(GL_PIXEL_MAP_I_TO_G, 32, values);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_PACK_BUFFER, 512, nullptr, GL_DYNAMIC_COPY);
    glGetPolygonStipple(nullptr);
    glGetPixelMapfv(GL_PIXEL_MAP_I_TO_G, reinterpret_cast<GLfloat*>(256));
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glPolygonStipple(solid);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glPolygonStipple(nullptr);
    enterCell(window);
    glDrawPixels(8, 4, GL_LUMINANCE, GL_FLOAT, mapAt);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glDeleteBuffers(1, &buffer);
    glEnable(GL_POLYGON_STIPPLE);
    glColor3f(1, 0.6F, 0);
    glRecti(window.width() - 70, window.height() / 2 - 15, window.width() - 5, window.height() / 2 + 25);
    glDisable(GL_POLYGON_STIPPLE);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.alpha = 8;
    return runInGlxWindow(
        argc, argv, spec, [](Window&) {},
        [](Window& window, int frame) {
            glClearColor(0.2F, 0.3F, 0.1F, 0.5F);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, window.width(), 0, window.height(), -1, 1);
            cellIndex = 0;
            const auto number = unsigned(frame);
            drawScene(window, number);
            readFormats(window, number);
            readWithPackState(window, number);
            readAcrossEdges(window, number);
            readIntoBuffer(window, number);
            readDepthAndStencil(window, number);
            readTransferred(window);
            readState(window, number);
        });
}
