// A second thread with a context of the same share group records the first one's drawing. Each frame is read into the
// next of three pixel buffers, followed by a fence. The recorder maps them in turn, one frame later, and makes other
// reads meanwhile. Sums of the pixels are shown.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>

using namespace programs;

namespace {

constexpr int kBuffers = 3;
GLuint buffers[kBuffers], target, framebuffer;
std::mutex mutex;
std::condition_variable changed;
int framesRead = 0, framesRecorded = 0; // the following members are guarded too
bool ends = false;
GLsync fences[kBuffers];
std::uint32_t sums[kBuffers];

std::uint32_t sum(const GLubyte* bytes, std::size_t count) {
    std::uint32_t hash = 2166136261U;
    for (std::size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 16777619U;
    return hash;
}

std::uint32_t recordOne(GLuint buffer, GLsync fence, std::size_t bytes) {
    if (glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 60000000000) == GL_TIMEOUT_EXPIRED)
        fail("a fence is never reached");
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    const auto* const mapped = static_cast<const GLubyte*>(glMapBuffer(GL_PIXEL_PACK_BUFFER, GL_READ_ONLY));
    if (!mapped) fail("the recorder can't map a buffer");
    std::uint32_t readBack = sum(mapped, bytes);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    GLubyte pixel[4] = {};
    glClearColor(float(readBack % 251) / 255, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glReadPixels(3, 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel); // a round trip of its own
    return readBack + pixel[0];
}

void recorder(Window& own, std::size_t bytes) {
    own.makeCurrent();
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    std::unique_lock lock(mutex);
    for (;;) {
        changed.wait(lock, [] { return ends || framesRead > framesRecorded; });
        if (framesRead == framesRecorded) break;
        const int turn = framesRecorded % kBuffers;
        lock.unlock();
        const std::uint32_t readBack = recordOne(buffers[turn], fences[turn], bytes);
        lock.lock();
        sums[turn] = readBack;
        ++framesRecorded;
        changed.notify_all();
    }
    lock.unlock();
    own.release();
}

void draw(int frame) {
    glClearColor(0.1F, 0.2F, 0.02F * float(frame % 50), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    Sequence numbers(unsigned(frame) + 9);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 60; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(2 * numbers.unit() - 1, 2 * numbers.unit() - 1);
    }
    glEnd();
}

void readFrame(const Window& window, int frame) {
    const int turn = frame % kBuffers;
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return framesRecorded + 2 > frame; }); // at most one frame late
    if (frame >= 2) showBits(1, sums[(frame - 2) % kBuffers]);
    if (frame >= kBuffers) glDeleteSync(fences[turn]);
    lock.unlock();
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[turn]);
    glReadPixels(0, 0, window.width(), window.height(), GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    lock.lock();
    fences[turn] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    ++framesRead;
    changed.notify_all();
}

void setUp(std::size_t bytes) {
    glGenBuffers(kBuffers, buffers);
    for (const GLuint buffer : buffers) {
        glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
        glBufferData(GL_PIXEL_PACK_BUFFER, GLsizeiptr(bytes), nullptr, GL_STREAM_READ);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glGenTextures(1, &target);
    glBindTexture(GL_TEXTURE_2D, target);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glBindTexture(GL_TEXTURE_2D, 0);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    const auto own = openGlxWindow({}, 32, 32, window.get());
    window->makeCurrent();
    const auto bytes = std::size_t(options.width) * std::size_t(options.height) * 4;
    setUp(bytes);
    glFinish();
    std::thread thread([&] { recorder(*own, bytes); });
    for (int frame = 0; frame < options.frames; ++frame) {
        draw(frame);
        readFrame(*window, frame);
        checkNoError("with a recorder");
        window->swap();
    }
    {
        const std::lock_guard lock(mutex);
        ends = true;
        changed.notify_all();
    }
    thread.join();
    return 0;
}
