// One thread draws, the other resizes the window in the middle of its frames. It also changes to the size of the screen
// and back, as programs do that toggle full screen.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>

using namespace programs;

namespace {

// Steps that two threads take in turn.
class Turns {
public:
    void reach(int step) {
        const std::lock_guard<std::mutex> lock(mutex_);
        step_ = step;
        changed_.notify_all();
    }
    void await(int step) {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] { return step_ >= step; });
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int step_ = 0;
};
Turns turns; // 2n+1: frame n is half drawn; 2n+2: the window has its new size

void drawHalf(int frame, bool second) {
    Sequence numbers(unsigned(frame * 2) + (second ? 1U : 0U));
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 12; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), second ? 0.2F : 0.9F);
        glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
}

void runDrawing(programs::Window& window, int frames) {
    window.makeCurrent();
    for (int frame = 0; frame < frames; ++frame) {
        glViewport(0, 0, window.width(), window.height()); // size after the last frame's resize
        glClearColor(0.1F, 0.2F, 0.1F * float(frame % 6), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        drawHalf(frame, false);
        turns.reach(frame * 2 + 1);
        turns.await(frame * 2 + 2);
        drawHalf(frame, true);
        checkNoError("in a window that is resized");
        window.swap();
    }
    window.release();
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    Display* display = openDisplayOnce();
    std::thread drawing(runDrawing, std::ref(*window), options.frames);
    for (int frame = 0; frame < options.frames; ++frame) {
        turns.await(frame * 2 + 1);
        if (frame % 4 == 1) {
            window->resize(DisplayWidth(display, DefaultScreen(display)),
                           DisplayHeight(display, DefaultScreen(display)));
        } else {
            window->resize(options.width + 3 + frame * 7 % 40, options.height - frame * 5 % 30);
        }
        turns.reach(frame * 2 + 2);
    }
    drawing.join();
    return 0;
}
