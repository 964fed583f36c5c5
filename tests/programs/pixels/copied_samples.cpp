// glCopyPixels in a multisampled window: to other places, onto itself, zoomed and blended, into a framebuffer object
// and back. The copy is read, partly overdrawn, and copied again, so its samples matter.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 40;
GLuint framebuffer;

// Draws slanted edges, so that few pixels have all samples of one colour.
void fan(float x, float y, float size, int frame) {
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 24; ++i) {
        const float turn = 0.27F * float(i) + 0.05F * float(frame);
        glColor3f(float(i % 3) * 0.4F, float(i % 5) * 0.2F, float(i % 7) * 0.15F);
        glVertex2f(x, y);
        glVertex2f(x + size * (turn - float(int(turn))), y + size * float(i) / 24);
        glVertex2f(x + size * float(24 - i) / 24, y + size * 0.9F);
    }
    glEnd();
}

void setUp(Window&) {
    glClear(GL_COLOR_BUFFER_BIT);
    glCopyPixels(0, 0, 1, 1, GL_COLOR); // a node's pixels from before the first copy reach the others without samples
    GLuint color = 0;
    glGenRenderbuffers(1, &color);
    glBindRenderbuffer(GL_RENDERBUFFER, color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kSize, kSize);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

std::uint32_t sumOf(int x, int y) {
    std::vector<GLubyte> read(std::size_t(kSize) * kSize * 4);
    glReadPixels(x, y, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
    std::uint32_t sum = 0;
    for (const GLubyte value : read) sum = sum * 31 + value;
    return sum;
}

void copyAbout(const Window& window, int frame) {
    const int w = window.width(), h = window.height(), x = w / 2 - 20, y = h / 2 - 20;
    glWindowPos2i(8, h - 60); // across all four tiles of 2x2
    glCopyPixels(x, y, kSize, kSize, GL_COLOR);
    glWindowPos2i(x + 5, y + 3); // onto itself
    glCopyPixels(x, y, kSize, kSize, GL_COLOR);
    glPixelZoom(1.5F, 0.75F);
    glWindowPos2i(w - 80, 30);
    glCopyPixels(x, y, kSize, kSize, GL_COLOR);
    glPixelZoom(1, 1);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glWindowPos2i(w - 70, h - 70);
    glCopyPixels(x, y, kSize, kSize, GL_COLOR);
    glDisable(GL_BLEND);
    fan(12, float(h - 56), 30, frame + 3); // covers some samples of the copy
    glWindowPos2i(70, 20);
    glCopyPixels(8, h - 60, kSize, kSize, GL_COLOR);
    showBits(1, sumOf(8, h - 60));
    showBits(2, sumOf(70, 20));
}

void copyThroughObject(const Window& window) {
    const int w = window.width(), h = window.height();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kSize, kSize);
    glWindowPos2i(0, 0);
    glCopyPixels(w / 2 - 20, h / 2 - 20, kSize, kSize, GL_COLOR);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    showBits(3, sumOf(0, 0));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glViewport(0, 0, w, h);
    glWindowPos2i(10, 30);
    glCopyPixels(0, 0, kSize, kSize, GL_COLOR);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.samples = 4;
    return runInGlxWindow(argc, argv, spec, setUp, [](Window& window, int frame) {
        glViewport(0, 0, window.width(), window.height());
        glClearColor(0.1F, 0.2F, 0.1F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glMatrixMode(GL_PROJECTION);
        glLoadIdentity();
        glOrtho(0, window.width(), 0, window.height(), -1, 1);
        glMatrixMode(GL_MODELVIEW);
        const auto w = float(window.width()), h = float(window.height());
        fan(w / 2 - 40, h / 2 - 40, 90, frame);
        fan(5, 5, w * 0.3F, frame + 1);
        copyThroughObject(window);
        copyAbout(window, frame);
        checkNoError("after copies of samples");
    });
}
