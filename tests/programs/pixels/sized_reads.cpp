// Reads with a buffer size: sufficient, exact, and one byte too small, which is an error that leaves the memory
// unchanged. With pack state, into memory and into a buffer. The results are drawn.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <functional>
#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 32;
constexpr int kX = 100, kY = 80, kWidth = 21, kHeight = 9; // rectangle of the window that is read: odd rows
constexpr GLsizei kBuffer = 4 * kSize * kSize + 256;
GLuint texture, packed;
int row;

std::uint32_t sum(const std::vector<GLubyte>& bytes) {
    std::uint32_t hash = 2166136261U;
    for (const GLubyte b : bytes) hash = (hash ^ b) * 16777619U;
    return hash;
}

void setUp(Window&) {
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glGenBuffers(1, &packed);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, packed);
    glBufferData(GL_PIXEL_PACK_BUFFER, kBuffer, nullptr, GL_STREAM_READ);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void drawAndCopy(const Window& window, int frame) {
    glClearColor(0.3F, 0.1F * float(frame), 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    Sequence numbers(unsigned(frame) + 77);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 90; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(2 * numbers.unit() - 1, 2 * numbers.unit() - 1);
    }
    glEnd();
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (window.width() - kSize) / 2, (window.height() - kSize) / 2, kSize,
                        kSize);
}

void expect(GLenum wanted, const char* what) {
    const GLenum error = glGetError();
    if (error != wanted) fail("%s: error %#x instead of %#x", what, error, wanted);
}

// read(room, where) reads a picture that needs `bytes` bytes.
using Read = std::function<void(GLsizei, void*)>;

void intoMemory(const char* what, GLsizei bytes, const Read& read) {
    std::vector<GLubyte> memory(kBuffer, 0x5a);
    const std::vector<GLubyte> untouched = memory;
    read(bytes - 1, memory.data());
    expect(GL_INVALID_OPERATION, what);
    if (memory != untouched) fail("%s: wrote into too little room", what);
    read(bytes, memory.data());
    expect(GL_NO_ERROR, what);
    if (memory[std::size_t(bytes)] != 0x5a) fail("%s: wrote behind its room", what);
    showBits(row++, sum(memory));
    memory = untouched;
    read(kBuffer, memory.data());
    expect(GL_NO_ERROR, what);
    showBits(row++, sum(memory));
}

// Reads into a buffer. Its size is the limit then, except for glReadnPixels and similar functions, which respect both.
void intoBuffer(const char* what, GLsizei bytes, const Read& read) {
    std::vector<GLubyte> memory(kBuffer, 0x33);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, packed);
    glBufferSubData(GL_PIXEL_PACK_BUFFER, 0, kBuffer, memory.data());
    read(kBuffer,
         reinterpret_cast<void*>(std::uintptr_t(kBuffer - bytes + 4))); // NOLINT(performance-no-int-to-ptr): an offset
    expect(GL_INVALID_OPERATION, what);
    read(kBuffer, reinterpret_cast<void*>(std::uintptr_t(64))); // NOLINT(performance-no-int-to-ptr)
    expect(GL_NO_ERROR, what);
    glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, kBuffer, memory.data());
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    showBits(row++, sum(memory));
    // The nodes have these bytes, too, because they draw from them.
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, packed);
    glWindowPos2i(2 + row * 16, 150);
    glDrawPixels(14, 20, GL_RGBA, GL_UNSIGNED_BYTE,
                 reinterpret_cast<const void*>(std::uintptr_t(64))); // NOLINT(performance-no-int-to-ptr)
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

void inAllWays(const char* what, GLsizei bytes, const Read& read) {
    intoMemory(what, bytes, read);
    intoBuffer(what, bytes, read);
}

void showReads() {
    row = 0;
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    const GLsizei window = (kWidth * 3 + 3) / 4 * 4 * (kHeight - 1) + kWidth * 3, image = kSize * kSize * 4;
    inAllWays("glReadnPixels", window, [](GLsizei room, void* to) {
        glReadnPixels(kX, kY, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, room, to);
    });
    inAllWays("glReadnPixelsARB", window, [](GLsizei room, void* to) {
        glReadnPixelsARB(kX, kY, kWidth, kHeight, GL_BGR, GL_UNSIGNED_BYTE, room, to);
    });
    inAllWays("glGetnTexImageARB", image,
              [](GLsizei room, void* to) { glGetnTexImageARB(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, room, to); });
    inAllWays("glGetTextureImage", image,
              [](GLsizei room, void* to) { glGetTextureImage(texture, 0, GL_BGRA, GL_UNSIGNED_BYTE, room, to); });
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, kSize + 3);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 2);
    glPixelStorei(GL_PACK_SKIP_ROWS, 1);
    const GLsizei apart = ((kSize + 3) * kSize + 2 + kSize) * 2;
    inAllWays("glGetnTexImageARB, apart", apart,
              [](GLsizei room, void* to) { glGetnTexImageARB(GL_TEXTURE_2D, 0, GL_RG, GL_UNSIGNED_BYTE, room, to); });
    for (const GLenum name : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS}) glPixelStorei(name, 0);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(argc, argv, {}, setUp, [](Window& window, int frame) {
        drawAndCopy(window, frame);
        showReads();
    });
}
