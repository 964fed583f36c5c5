#include "tests/programs/support/show.hpp"

#include <GL/gl.h>
#include <algorithm>
#include <cstring>

namespace programs {

void fillRectangle(int x, int y, int width, int height, Color color) {
    const GLboolean scissored = glIsEnabled(GL_SCISSOR_TEST);
    GLint box[4];
    GLfloat clear[4];
    glGetIntegerv(GL_SCISSOR_BOX, box);
    glGetFloatv(GL_COLOR_CLEAR_VALUE, clear);
    glEnable(GL_SCISSOR_TEST);
    glScissor(x, y, width, height);
    glClearColor(color.red, color.green, color.blue, color.alpha);
    glClear(GL_COLOR_BUFFER_BIT);
    glClearColor(clear[0], clear[1], clear[2], clear[3]);
    glScissor(box[0], box[1], box[2], box[3]);
    if (scissored == GL_FALSE) {
        glDisable(GL_SCISSOR_TEST);
    }
}

void showBits(int row, std::uint32_t value) {
    for (int bit = 0; bit < 32; ++bit) {
        const bool set = ((value >> bit) & 1U) != 0;
        const Color color = set ? Color{1.0F, 0.9F, 0.2F} : Color{0.1F, 0.1F, 0.4F};
        fillRectangle(bit * 5, row * 5, 4, 4, color);
    }
}

void showBits(int row, float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    showBits(row, bits);
}

void showBar(int row, std::int64_t value) {
    const int length = static_cast<int>(std::clamp<std::int64_t>(value, 0, 250));
    fillRectangle(0, row * 5, length, 4, {0.2F, 0.9F, 0.5F});
}

} // namespace programs
