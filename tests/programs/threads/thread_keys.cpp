// A thread draws most of its frames in the destructor of a pthread key, created after its context. Meanwhile another
// thread begins to draw into a window of its own.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <condition_variable>
#include <mutex>
#include <pthread.h>
#include <thread>
#include <vector>

using namespace programs;

namespace {

std::mutex turnLock;
std::condition_variable turnChanged;
int turn = 0; // even: the ending thread draws, odd: the other thread

struct Ending {
    Window& window;
    int frames;
};

void waitForTurn(int number) {
    std::unique_lock<std::mutex> lock(turnLock);
    turnChanged.wait(lock, [&] { return turn == number; });
}

void passTurn() {
    const std::lock_guard<std::mutex> lock(turnLock);
    ++turn;
    turnChanged.notify_all();
}

void drawFrame(Window& window, int thread, int frame) {
    Sequence numbers(unsigned(thread * 100 + frame));
    glClearColor(0.2F * float(thread), 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 30; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 1.8F - 0.9F, numbers.unit() * 1.8F - 0.9F);
    }
    glEnd();
    GLubyte seen[4] = {};
    glReadPixels(window.width() / 2, window.height() / 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, seen);
    showBits(0, std::uint32_t(seen[0]) << 16 | std::uint32_t(seen[1]) << 8 | seen[2]);
    checkNoError("in a thread");
    window.swap();
}

void drawInTurns(Window& window, int thread, int first, int frames) {
    for (int frame = first; frame < frames; ++frame) {
        waitForTurn(2 * frame + thread);
        drawFrame(window, thread, frame);
        passTurn();
    }
    window.release();
}

void drawAtEnd(void* argument) {
    const auto& ending = *static_cast<Ending*>(argument);
    drawInTurns(ending.window, 0, 1, ending.frames);
}

void runEnding(Ending& ending) {
    ending.window.makeCurrent();
    waitForTurn(0);
    drawFrame(ending.window, 0, 0);
    pthread_key_t key = 0;
    if (pthread_key_create(&key, drawAtEnd) != 0) fail("no key for thread-specific data");
    pthread_setspecific(key, &ending);
    passTurn();
}

void runOther(Window& window, int frames) {
    waitForTurn(1);
    window.makeCurrent();
    drawInTurns(window, 1, 0, frames);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    WindowSpec spec;
    const auto first = openGlxWindow(spec, options.width, options.height);
    spec.x = options.width;
    const auto second = openGlxWindow(spec, options.width - 20, options.height - 10);
    Ending ending{*first, options.frames};
    std::thread endingThread(runEnding, std::ref(ending));
    std::thread other(runOther, std::ref(*second), options.frames);
    endingThread.join();
    other.join();
    return 0;
}
