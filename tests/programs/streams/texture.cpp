// A texture of 64 MiB that is uploaded whole for every frame: unchanged, or with a different patch of MURAL_PATCH ×
// MURAL_PATCH pixels changed each time. The environment variable TEXTURE_SIDE replaces its width and height of 4096.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdint>
#include <cstdlib>
#include <vector>

using namespace programs;

namespace {

const int side = std::getenv("TEXTURE_SIDE") ? std::atoi(std::getenv("TEXTURE_SIDE")) : 4096;
std::vector<std::uint32_t> pixels(size_t(side) * size_t(side));
GLuint texture;

void setUp(Window&) {
    Sequence numbers(3);
    for (std::uint32_t& pixel : pixels) pixel = numbers.next() * 257U;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glEnable(GL_TEXTURE_2D);
}

void changePatch(int frame) {
    Sequence numbers(1000U + std::uint32_t(frame));
    const int x = 173 * frame % (side - MURAL_PATCH), y = 311 * frame % (side - MURAL_PATCH);
    for (int row = 0; row < MURAL_PATCH; ++row)
        for (int column = 0; column < MURAL_PATCH; ++column)
            pixels[size_t(y + row) * size_t(side) + size_t(x + column)] = numbers.next() * 257U;
}

void draw(Window&, int frame) {
    changePatch(frame);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, side, side, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glClear(GL_COLOR_BUFFER_BIT);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(-1, -1), glTexCoord2f(1, 0), glVertex2f(1, -1);
    glTexCoord2f(1, 1), glVertex2f(1, 1), glTexCoord2f(0, 1), glVertex2f(-1, 1);
    glEnd();
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
