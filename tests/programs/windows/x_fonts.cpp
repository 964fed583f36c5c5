// Text with glXUseXFont: the driver's own display lists of bitmaps. Inked, empty and missing characters of two server
// fonts, placed one after the other; raster positions, errors and pixel storage are shown.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <GL/glx.h>

using namespace programs;

namespace {

constexpr GLuint kText = 100, kSymbols = 600; // bases of the lists
constexpr int kTextCount = 300, kSymbolCount = 100;
GLenum errors[2];

GLenum makeLists(const char* fontName, int first, int count, GLuint base) {
    XFontStruct* font = XLoadQueryFont(openDisplayOnce(), fontName);
    if (!font) {
        fail("the X server has no font \"%s\"", fontName);
    }
    glXUseXFont(font->fid, first, count, int(base));
    XFreeFont(openDisplayOnce(), font);
    return glGetError();
}

void showRasterPosition(int row) {
    GLfloat place[4];
    glGetFloatv(GL_CURRENT_RASTER_POSITION, place);
    showBits(row, place[0]);
    showBits(row + 1, place[1]);
}

void setup(programs::Window& window) {
    glOrtho(0, window.width(), 0, window.height(), -1, 1);
    glPixelStorei(GL_UNPACK_LSB_FIRST, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 77);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 3);
    errors[0] = makeLists("fixed", 0, kTextCount, kText);
    errors[1] = makeLists("cursor", 20, kSymbolCount, kSymbols);
    glNewList(kText + kTextCount, GL_COMPILE); // calls others
    glCallList(kText + 'M');
    glCallList(kText + 'x');
    glEndList();
}

void draw(programs::Window& window, int frame) {
    glClearColor(0.1F, 0.2F, 0.1F * float(frame % 4), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const int height = window.height();
    for (int line = 0; line < 3; ++line) {
        glColor3f(1, 0.5F + 0.1F * float(line), float(frame % 2));
        glRasterPos2i(3 + frame, height - 16 * (line + 1));
        glListBase(kText);
        const GLubyte text[] = {'W', 'a', 'l', 'l', 'j', 1, 31, 127, 'g', 200, 'Q', GLubyte('a' + frame)};
        glCallLists(sizeof text, GL_UNSIGNED_BYTE, text);
        glCallList(kText + 299); // not in the font
        showRasterPosition(2 * line);
        glCallList(kText + kTextCount);
    }
    showRasterPosition(6);
    glRasterPos2i(10, height / 2);
    for (int i = 0; i < 12; ++i) {
        glCallList(kSymbols + GLuint(i * 8 + frame % 8));
    }
    showRasterPosition(8);
    GLint rowLength = 0, alignment = 0;
    glGetIntegerv(GL_UNPACK_ROW_LENGTH, &rowLength);
    glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment);
    showBits(10, std::uint32_t(rowLength * 16 + alignment));
    showBits(11, std::uint32_t(errors[0] * 65536 + errors[1]));
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setup, draw); }
