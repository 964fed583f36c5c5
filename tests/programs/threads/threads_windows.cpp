// Three threads, each with a window and a context of its own, drawing at the same time.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

using namespace programs;

namespace {

constexpr int kThreads = 3;
std::mutex turnLock;
std::condition_variable turnChanged;
int turn = 0;

// Orders only the first frames, by which tests identify the windows.
void takeTurn(int thread) {
    std::unique_lock<std::mutex> lock(turnLock);
    turnChanged.wait(lock, [&] { return turn == thread; });
}

void passTurn() {
    const std::lock_guard<std::mutex> lock(turnLock);
    ++turn;
    turnChanged.notify_all();
}

void drawFixed(int thread, int frame) {
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glRotatef(float(frame * 7 + thread * 40), 0, 0, 1);
    glBegin(GL_TRIANGLES);
    Sequence numbers(unsigned(thread * 100 + frame));
    for (int i = 0; i < 30; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 1.8F - 0.9F, numbers.unit() * 1.8F - 0.9F);
    }
    glEnd();
}

// Draws with objects that have equal names in unrelated contexts.
void drawBuffered(int thread, int frame, GLuint program, GLuint buffer) {
    GLfloat places[24];
    Sequence numbers(unsigned(thread * 31 + frame));
    for (GLfloat& place : places) {
        place = numbers.unit() - (thread == 0 ? 1.0F : 0.0F);
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof places, places, GL_STREAM_DRAW);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    glUseProgram(program);
    glUniform1f(glGetUniformLocation(program, "thread"), float(thread) * 0.4F);
    glDrawArrays(GL_TRIANGLES, 0, 12);
    glUseProgram(0);
    glDisableVertexAttribArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void runThread(int thread, Window& window, int frames) {
    window.makeCurrent();
    const GLuint program =
        buildProgram({{GL_VERTEX_SHADER,
                       "#version 120\nattribute vec2 place; void main() { gl_Position = vec4(place, 0.0, 1.0); }\n"},
                      {GL_FRAGMENT_SHADER, "#version 120\nuniform float thread; void main() { gl_FragColor = "
                                           "vec4(thread, fract(gl_FragCoord.x / 9.0), 0.5, 1.0); }\n"}},
                     [](unsigned linking) { glBindAttribLocation(linking, 0, "place"); });
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    for (int frame = 0; frame < frames; ++frame) {
        if (frame == 0) {
            takeTurn(thread);
        }
        glClearColor(0.1F * float(thread), 0.1F, 0.2F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        drawFixed(thread, frame);
        drawBuffered(thread, frame, program, buffer);
        checkNoError("in a thread");
        window.swap();
        if (frame == 0) {
            passTurn();
        }
    }
    window.release();
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    std::vector<std::unique_ptr<Window>> windows;
    std::vector<std::thread> threads;
    WindowSpec spec;
    for (int i = 0; i < kThreads; ++i) {
        spec.x = i * options.width / 2;
        spec.y = i * 20;
        windows.push_back(openGlxWindow(spec, options.width - i * 20, options.height - i * 10));
    }
    for (int i = 0; i < kThreads; ++i) {
        threads.emplace_back(runThread, i, std::ref(*windows[std::size_t(i)]), options.frames);
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    return 0;
}
