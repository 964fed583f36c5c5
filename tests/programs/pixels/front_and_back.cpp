// Front and back buffer of one window in turns: their colours are separate, depth and stencil are common, and copies go
// from one to the other. The pixels read are shown in the next frame.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kWidth = 100, kHeight = 70;
using Pixels = std::vector<GLubyte>;

void drawTriangles(unsigned seed) {
    Sequence numbers(seed);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 30; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex3f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
}

void clearColour(float red, float green, float blue) {
    glClearColor(red, green, blue, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

Pixels readFrom(GLenum buffer, int x, int y, GLenum format = GL_RGBA) {
    Pixels pixels(kWidth * kHeight * 4);
    format == GL_RGBA ? glReadBuffer(buffer) : glFramebufferReadBufferEXT(0, buffer);
    glReadPixels(x, y, kWidth, kHeight, format, format == GL_DEPTH_COMPONENT ? GL_UNSIGNED_INT : GL_UNSIGNED_BYTE,
                 pixels.data());
    return pixels;
}

// Returns pixels of the read buffer, copied through a texture.
Pixels copied(GLenum buffer, int x, int y) {
    Pixels pixels(kWidth * kHeight * 4);
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glReadBuffer(buffer);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, x, y, kWidth, kHeight, 0);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glDeleteTextures(1, &texture);
    return pixels;
}

std::vector<Pixels> useBoth(const Window& window, int frame) {
    const int x = window.width() / 2 - kWidth / 2 + frame, y = window.height() / 2 - kHeight / 2;
    glEnable(GL_DEPTH_TEST);
    glDrawBuffer(GL_BACK);
    glClear(GL_DEPTH_BUFFER_BIT);
    clearColour(0, 0.5F, 0.1F * float(frame % 5));
    drawTriangles(unsigned(frame) + 10);
    glDrawBuffer(GL_FRONT); // fragments of the back hide its fragments
    clearColour(0.4F, 0, 0.1F * float(frame % 7));
    drawTriangles(unsigned(frame) + 40);
    glDrawBuffer(GL_BACK);
    drawTriangles(unsigned(frame) + 70);
    std::vector<Pixels> read{readFrom(GL_FRONT, x, y), readFrom(GL_BACK, x, y), readFrom(GL_FRONT, x, y, GL_RGB),
                             copied(GL_FRONT, x, y), readFrom(GL_FRONT, x, y, GL_DEPTH_COMPONENT)};
    glDisable(GL_DEPTH_TEST);
    glDrawBuffer(GL_FRONT);
    glReadBuffer(GL_BACK);
    glBlitFramebuffer(x, y, x + kWidth / 2, y + kHeight, x, y, x + kWidth / 2, y + kHeight, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glReadBuffer(GL_FRONT);
    glDrawBuffer(GL_BACK);
    glWindowPos2i(x + kWidth / 3, y);
    glCopyPixels(x, y, kWidth / 3, kHeight, GL_COLOR);
    read.push_back(readFrom(GL_FRONT, x, y));
    read.push_back(readFrom(GL_BACK, x, y));
    glDrawBuffer(GL_FRONT_AND_BACK);
    glEnable(GL_SCISSOR_TEST);
    glScissor(x, y, kWidth, kHeight);
    clearColour(0.7F, 0.7F, 0.1F * float(frame % 3));
    glDisable(GL_SCISSOR_TEST);
    drawTriangles(unsigned(frame) + 90);
    glDrawBuffer(GL_BACK);
    clearColour(0.1F, 0.2F, 0.3F);
    drawTriangles(unsigned(frame) + 5);
    glPushAttrib(GL_COLOR_BUFFER_BIT | GL_PIXEL_MODE_BIT);
    glDrawBuffer(GL_FRONT);
    drawTriangles(unsigned(frame) + 15);
    glPopAttrib();
    read.push_back(readFrom(GL_FRONT, x, y)); // drawn again since both were drawn
    read.push_back(readFrom(GL_LEFT, x, y));  // of several buffers, reads use the front
    return read;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    std::vector<Pixels> shown;
    for (int frame = 0; frame < options.frames; ++frame) {
        std::vector<Pixels> read = useBoth(*window, frame);
        int place = 0;
        for (const Pixels& pixels : shown) {
            glWindowPos2i(place % 2 * (kWidth + 4), place / 2 * (kHeight / 3));
            glDrawPixels(kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
            ++place;
        }
        checkNoError("front and back");
        window->swap();
        shown = std::move(read);
    }
    return 0;
}
