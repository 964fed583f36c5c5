// Records what it shows as programs do that do not want to wait: each frame is read into one of three, then two pixel
// buffers, and the one of two frames before, or one, is mapped. Its bytes are shown as a sum and drawn again.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdint>

using namespace programs;

namespace {

constexpr int kMost = 3, kTurn = 40; // frames with three buffers, then as many with two
GLuint buffers[kMost];

void moving(int frame) {
    glClearColor(0.1F, 0.02F * float(frame % 50), 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    Sequence numbers(unsigned(frame) / 7 + 3);
    const float shift = 0.1F * float(frame % 7);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 60; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(2 * numbers.unit() - 1.3F + shift, 2 * numbers.unit() - 1);
    }
    glEnd();
}

std::uint32_t sum(const GLubyte* bytes, std::size_t count) {
    std::uint32_t hash = 2166136261U;
    for (std::size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 16777619U;
    return hash;
}

void showRead(const Window& window, GLuint buffer) {
    const auto bytes = std::size_t(window.width()) * std::size_t(window.height()) * 4;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    const auto* const mapped = static_cast<const GLubyte*>(glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, GLsizeiptr(bytes), GL_MAP_READ_BIT));
    if (!mapped) fail("a buffer that was read into can't be mapped");
    const std::uint32_t told = sum(mapped, bytes);
    glPixelZoom(0.4F, 0.4F);
    glWindowPos2i(window.width() / 2, window.height() / 2);
    glDrawPixels(window.width(), window.height(), GL_BGRA, GL_UNSIGNED_BYTE, mapped);
    glPixelZoom(1, 1);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    showBits(1, told);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc,
        argv,
        {},
        [](Window& window) {
            glGenBuffers(kMost, buffers);
            for (const GLuint buffer : buffers) {
                glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
                glBufferData(GL_PIXEL_PACK_BUFFER, GLsizeiptr(window.width()) * window.height() * 4, nullptr, GL_STREAM_READ);
            }
        },
        [](Window& window, int frame) {
            moving(frame);
            const int used = frame / kTurn % 2 == 0 ? kMost : 2, since = frame % kTurn;
            glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[since % used]);
            glReadPixels(0, 0, window.width(), window.height(), GL_BGRA, GL_UNSIGNED_BYTE, nullptr);
            if (since + 1 >= used) showRead(window, buffers[(since + 1) % used]);
        });
}
