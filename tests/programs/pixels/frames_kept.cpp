// Windows whose frames depend on the previous frame, each in another way:
//   - without clears, with clears only at first, with a partial clear;
//   - a depth buffer that stays, a copy of the window, conditional rendering;
//   - reads before drawing, frames without drawing.
// Two windows clear everything, with old and with new commands.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kCopied = 48; // pixels per side

struct Place {
    const Window& window;
    int frame;
    GLuint object; // object of this window's context
};

void clearAll(int frame) {
    glClearColor(0.1F, 0.05F * float(frame % 9), 0.3F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

// Draws a triangle with another place, tone and depth each time.
void addTriangle(int frame) {
    Sequence numbers(unsigned(frame) + 40);
    const float x = numbers.unit() * 1.4F - 0.7F, y = numbers.unit() * 1.4F - 0.7F, z = numbers.unit() * 1.6F - 0.8F;
    glColor3f(numbers.unit(), numbers.unit(), 1);
    glBegin(GL_TRIANGLES);
    glVertex3f(x - 0.5F, y - 0.4F, z);
    glVertex3f(x + 0.6F, y - 0.3F, -z);
    glVertex3f(x, y + 0.5F, z);
    glEnd();
}

void overIt(const Place& p) {
    if (p.frame == 0) clearAll(0);
    addTriangle(p.frame);
}

void overItLater(const Place& p) {
    if (p.frame < 4) clearAll(p.frame);
    addTriangle(p.frame);
}

void byTurns(const Place& p) {
    if (p.frame % 4 < 2) clearAll(p.frame);
    addTriangle(p.frame);
    addTriangle(p.frame + 100);
}

void depthStays(const Place& p) {
    glEnable(GL_DEPTH_TEST);
    if (p.frame == 0) clearAll(0);
    glClearColor(0.2F, 0.2F, 0.05F * float(p.frame % 9), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    addTriangle(p.frame);
    addTriangle(p.frame + 1);
}

void clearsParts(const Place& p) {
    if (p.frame == 0) clearAll(0);
    if (p.frame % 5 == 3) { // clears the whole window, but not all colours
        glColorMask(GL_TRUE, GL_FALSE, GL_FALSE, GL_FALSE);
        glClearColor(0.6F, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
    fillRectangle(7 * p.frame % 90, 11 * p.frame % 70, 30, 20, {0.5F, 0.1F * float(p.frame % 10), 0.9F});
}

void copies(const Place& p) {
    clearAll(p.frame);
    glBindTexture(GL_TEXTURE_2D, p.object);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    addTriangle(p.frame);
    if (p.frame > 0) {
        glEnable(GL_TEXTURE_2D);
        glColor3f(1, 1, 1);
        glBegin(GL_QUADS);
        glTexCoord2f(0, 0), glVertex2f(-0.2F, -0.9F);
        glTexCoord2f(1, 0), glVertex2f(0.9F, -0.8F);
        glTexCoord2f(1, 1), glVertex2f(0.8F, 0.6F);
        glTexCoord2f(0, 1), glVertex2f(-0.3F, 0.5F);
        glEnd();
        glDisable(GL_TEXTURE_2D);
    }
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, p.window.width() / 2 - kCopied, p.window.height() / 2 - kCopied,
                     2 * kCopied, 2 * kCopied, 0);
}

// Draws under the condition that the previous frame drew something within its scissor box.
void conditional(const Place& p) {
    clearAll(p.frame);
    if (p.frame > 0) glBeginConditionalRender(p.object, GL_QUERY_WAIT);
    addTriangle(p.frame);
    if (p.frame > 0) glEndConditionalRender();
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, p.window.width() * (p.frame % 3) / 2, p.window.height());
    glBeginQuery(GL_SAMPLES_PASSED, p.object);
    addTriangle(p.frame + 50);
    glEndQuery(GL_SAMPLES_PASSED);
    glDisable(GL_SCISSOR_TEST);
}

// Makes the contents before this frame's drawing part of the frame.
void readsAhead(const Place& p) {
    std::vector<GLubyte> pixels(kCopied * kCopied * 4);
    if (p.frame > 0)
        glReadPixels(p.window.width() / 3, p.window.height() / 3, kCopied, kCopied, GL_RGBA, GL_UNSIGNED_BYTE,
                     pixels.data());
    clearAll(p.frame);
    addTriangle(p.frame);
    glWindowPos2i(4, 4);
    glDrawPixels(kCopied, kCopied, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

void rests(const Place& p) {
    if (p.frame % 3 == 2) return;
    clearAll(p.frame);
    if (p.frame % 3 == 1) addTriangle(p.frame);
}

void clearsEverything(const Place& p) {
    glEnable(GL_DEPTH_TEST);
    clearAll(p.frame);
    for (int i = 0; i < 8; ++i) addTriangle(p.frame * 8 + i);
}

void clearsBuffers(const Place& p) {
    glEnable(GL_DEPTH_TEST);
    const GLfloat colour[] = {0.05F * float(p.frame % 9), 0.3F, 0.1F, 1};
    glClearBufferfv(GL_COLOR, 0, colour);
    glClearBufferfi(GL_DEPTH_STENCIL, 0, 1, 0);
    for (int i = 0; i < 8; ++i) addTriangle(p.frame * 8 + i);
}

using Way = void (*)(const Place&);
constexpr Way kWays[] = {overIt,      overItLater, byTurns, depthStays,       clearsParts,  copies,
                         conditional, readsAhead,  rests,   clearsEverything, clearsBuffers};

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    std::vector<std::unique_ptr<Window>> windows;
    std::vector<GLuint> objects;
    for (const Way way : kWays) {
        windows.push_back(openGlxWindow({}, options.width, options.height));
        windows.back()->makeCurrent();
        GLuint object = 0;
        way == conditional ? glGenQueries(1, &object) : glGenTextures(1, &object);
        objects.push_back(object);
    }
    // More frames than any test has turns; each window swaps equally often.
    for (int frame = 0; frame < 3 * options.frames; ++frame) {
        for (size_t i = 0; i < windows.size(); ++i) {
            windows[i]->makeCurrent();
            kWays[i]({*windows[i], frame, objects[i]});
            checkNoError("in a window");
            windows[i]->swap();
        }
    }
    return 0;
}
