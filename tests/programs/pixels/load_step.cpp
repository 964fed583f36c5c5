// Frames that move, cost the more from one frame on, and then stand still: the same commands again and again. By the
// environment: LOAD_LAYERS blended layers over the whole picture (4), LOAD_STEP_LAYERS (40) from frame LOAD_STEP (20)
// on. Frames from LOAD_STILL (60) on equal that one, or from the frame on that finds END_FILE. LOAD_FIRST (0): number
// of the first frame. LOAD_PAUSE_MS (0): pause before each frame; before frame LOAD_REST (none) one of 1.5 s.
// LOAD_REDRAW: from this frame on (none) each frame waits for an Expose event, at most 5 s, and equals the one before
// LOAD_REDRAW; prints "exposed" or "not exposed". Prints for each frame its time in ms, and the frame that it equals.
#include "tests/programs/support/environment.hpp"
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <GL/glx.h>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <unistd.h>

using namespace programs;

namespace {

void selectExposures() {
    XSelectInput(glXGetCurrentDisplay(), glXGetCurrentDrawable(), ExposureMask);
    XSync(glXGetCurrentDisplay(), False);
}

bool isExposed() {
    XEvent event;
    bool is = false;
    while (XCheckTypedEvent(glXGetCurrentDisplay(), Expose, &event) != 0) is = true;
    return is;
}

void awaitExposure() {
    int slices = 500;
    while (!isExposed() && --slices > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::puts(slices > 0 ? "exposed" : "not exposed");
}

void setUp(programs::Window&) {
    selectExposures();
    glEnable(GL_DEPTH_TEST);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

void triangles(Sequence& numbers) {
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 90; ++i) {
        if (i % 3 == 0) glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex3f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1, numbers.unit());
    }
    glEnd();
}

void layer(float x, Sequence& numbers) {
    glColor4f(numbers.unit(), numbers.unit(), numbers.unit(), 0.05F);
    glBegin(GL_QUADS);
    glVertex3f(x - 3, -1, -0.9F);
    glVertex3f(x + 3, -1, -0.9F);
    glVertex3f(x + 3, 1, -0.9F);
    glVertex3f(x - 3, 1, -0.9F);
    glEnd();
}

void draw(programs::Window&, int number) {
    static const char* const end = std::getenv("END_FILE");
    static int still = numberOf("LOAD_STILL", 60);
    static const int layersBefore = numberOf("LOAD_LAYERS", 4), step = numberOf("LOAD_STEP", 20),
                     layersAfter = numberOf("LOAD_STEP_LAYERS", 40), first = numberOf("LOAD_FIRST", 0),
                     pause = numberOf("LOAD_PAUSE_MS", 0), rest = numberOf("LOAD_REST", -1),
                     redraw = numberOf("LOAD_REDRAW", 1 << 30);
    const int frame = first + number;
    if (frame >= redraw)
        awaitExposure();
    else
        isExposed();
    std::this_thread::sleep_for(std::chrono::milliseconds(frame == rest ? 1500 : pause));
    if (end && access(end, F_OK) == 0) still = std::min(still, frame);
    const int at = std::min({frame, still, redraw - 1});
    const auto now = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch());
    std::printf("frame %d %.3f %d\n", frame, now.count(), at);
    std::fflush(stdout);
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glRotatef(float(at) * 3, 0, 0, 1);
    Sequence numbers(5);
    triangles(numbers);
    glLoadIdentity();
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    const int layers = frame < step ? layersBefore : layersAfter;
    for (int i = 0; i < layers; ++i) layer(0.01F * float((at + i) % 7), numbers);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {}, setUp, draw); }
