// Two threads with contexts that share: one uploads a texture and a buffer for each of many small cells, the other
// draws with them. Fences keep them in step in both directions. A cell drawn with the previous or the next contents is
// a wrong pixel.
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

constexpr int kCells = 60; // per frame
constexpr GLuint64 kPatienceNs = 20'000'000'000ULL;

// A slot for one fence, from one thread to the other.
class Handover {
public:
    void put(GLsync fence) {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] { return fence_ == nullptr; });
        fence_ = fence;
        changed_.notify_all();
    }
    GLsync take() {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [&] { return fence_ != nullptr; });
        const GLsync fence = fence_;
        fence_ = nullptr;
        changed_.notify_all();
        return fence;
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    GLsync fence_ = nullptr;
};

Handover loaded, drawn;
GLuint texture, buffer, target;

GLsync fence() {
    const GLsync made = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    return made;
}

void waitFor(GLsync sync, bool here) {
    if (here) {
        const GLenum state = glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, kPatienceNs);
        if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) {
            fail("a fence was not reached in time (0x%04x)", state);
        }
    } else {
        glWaitSync(sync, 0, GL_TIMEOUT_IGNORED);
    }
    glDeleteSync(sync);
}

void load(unsigned cell) {
    Sequence numbers(cell);
    GLubyte texels[8 * 8 * 4];
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 8, 8, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    const float size = 0.5F + 0.5F * numbers.unit();
    const float places[] = {-size, -size, size, -0.9F, -0.8F, size, 0.9F, 0.7F};
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    if (cell % 2 == 0) {
        glBufferSubData(GL_ARRAY_BUFFER, 0, sizeof places, places);
    } else {
        auto* mapped = static_cast<float*>(
            glMapBufferRange(GL_ARRAY_BUFFER, 0, sizeof places, GL_MAP_WRITE_BIT | GL_MAP_UNSYNCHRONIZED_BIT));
        for (int i = 0; i < 8; ++i) {
            mapped[i] = places[i];
        }
        glUnmapBuffer(GL_ARRAY_BUFFER);
    }
    if (cell % 3 == 0) { // drawn by this thread, too
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        fillRectangle(2, 2, 3, 4, {float(numbers.byte()) / 255, float(numbers.byte()) / 255, 0.2F});
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }
}

void runLoader(Window& window, unsigned cells) {
    window.makeCurrent();
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    for (unsigned cell = 0; cell < cells; ++cell) {
        if (cell > 0) {
            waitFor(drawn.take(), cell % 2 == 0);
        }
        load(cell);
        loaded.put(fence());
    }
    checkNoError("in the loading thread");
    waitFor(drawn.take(), true);
    window.release();
}

void makeShared() {
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 8, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 32, nullptr, GL_DYNAMIC_DRAW);
    GLuint vertexArray = 0;
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    glUseProgram(
        buildProgram({{GL_VERTEX_SHADER, "#version 330\nlayout(location=0) in vec2 place; out vec2 at; void main() { "
                                         "at = place * 0.5 + 0.5; gl_Position = vec4(place, 0, 1); }\n"},
                      {GL_FRAGMENT_SHADER, "#version 330\nin vec2 at; uniform sampler2D image; out vec4 result; void "
                                           "main() { result = vec4(texture(image, at).rgb, 1); }\n"}}));
    glFinish();
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const WindowSpec spec = {Profile::Core, 3, 3};
    const auto window = openGlxWindow(spec, options.width, options.height);
    WindowSpec otherWindow = spec;
    otherWindow.x = options.width;
    const auto loading = openGlxWindow(otherWindow, 8, 8, window.get()); // never drawn into
    window->makeCurrent();
    makeShared();
    std::thread loader(runLoader, std::ref(*loading), unsigned(options.frames * kCells));
    for (int frame = 0; frame < options.frames; ++frame) {
        glClearColor(0.1F, 0.2F, 0.2F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (int cell = 0; cell < kCells; ++cell) {
            waitFor(loaded.take(), cell % 5 == 0);
            glViewport(cell % 10 * options.width / 10, cell / 10 * options.height / 6, options.width / 10,
                       options.height / 6);
            glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
            drawn.put(fence());
        }
        checkNoError("in the drawing thread");
        window->swap();
    }
    loader.join();
    return 0;
}
