// Draws one frame per mouse click, and waits in between. Each frame turns a shaded surface and changes the colour of a
// square in the middle. tools/bench/page_latency measures the time from the click to this colour. The first line of
// output is "window ID".
#include <array>
#include <cmath>
#include <cstdio>
#include <poll.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

namespace {

constexpr int kCells = 48;    // of the surface, along each side
constexpr int kSquare = 48;   // pixels
constexpr float kTurn = 11;   // degrees per click
constexpr int kWaitMs = 1000; // so that END_FILE ends the program without a click

// Colours that stay apart after a lossy compression.
constexpr std::array<programs::Color, 4> kColors = {{{1, 0, 0}, {0, 0.8F, 0}, {0, 0, 1}, {1, 1, 0}}};

float heightAt(float x, float y) { return 0.25F * std::sin(5 * x) * std::cos(4 * y); }

void vertexAt(int column, int row) {
    const float step = 2.0F / kCells;
    const float x = static_cast<float>(column) * step - 1, y = static_cast<float>(row) * step - 1;
    const float slopeX = 1.25F * std::cos(5 * x) * std::cos(4 * y), slopeY = -std::sin(5 * x) * std::sin(4 * y);
    glNormal3f(-slopeX, -slopeY, 1);
    glColor3f((x + 1) / 2, (y + 1) / 2, 0.5F + heightAt(x, y));
    glVertex3f(x, y, heightAt(x, y));
}

void setUp(programs::Window&) {
    Display* display = programs::openDisplayOnce();
    const ::Window window = programs::topmostWindow(display);
    XSelectInput(display, window, ButtonPressMask);
    XSync(display, False);
    std::printf("window %lu\n", window);
    std::fflush(stdout);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_COLOR_MATERIAL);
    glEnable(GL_NORMALIZE);
    glNewList(1, GL_COMPILE);
    for (int row = 0; row < kCells; ++row) {
        glBegin(GL_QUAD_STRIP);
        for (int column = 0; column <= kCells; ++column) {
            vertexAt(column, row + 1);
            vertexAt(column, row);
        }
        glEnd();
    }
    glEndList();
}

// Blocks until a click, or for kWaitMs. Returns whether there was one.
bool isClicked(Display* display) {
    if (XPending(display) == 0) {
        pollfd file{ConnectionNumber(display), POLLIN, 0};
        poll(&file, 1, kWaitMs);
    }
    while (XPending(display) > 0) {
        XEvent event;
        XNextEvent(display, &event);
        if (event.type == ButtonPress) return true;
    }
    return false;
}

int clicks = 0;

void draw(programs::Window& window, int frame) {
    if (frame > 0 && isClicked(programs::openDisplayOnce())) ++clicks;
    glClearColor(0.1F, 0.1F, 0.15F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glLoadIdentity();
    glRotatef(-50, 1, 0, 0);
    glRotatef(kTurn * static_cast<float>(clicks), 0, 0, 1);
    glScalef(0.7F, 0.7F, 0.7F);
    glCallList(1);
    programs::fillRectangle((window.width() - kSquare) / 2, (window.height() - kSquare) / 2, kSquare, kSquare,
                            kColors[static_cast<size_t>(clicks) % kColors.size()]);
    if (frame == 0) std::printf("frame 0\n");
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) { return programs::runInGlxWindow(argc, argv, {}, setUp, draw); }
