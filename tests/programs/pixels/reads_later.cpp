// Records its frames as programs do that avoid waiting. Each frame is read into one of three, later two, pixel buffers,
// and the buffer of two frames before, or one, is mapped. Its bytes are shown as a sum and drawn again. Parts of
// textures are read into other buffers and mapped equally late.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdint>

using namespace programs;

namespace {

constexpr int kMax = 3, kTurn = 40; // frames with three buffers, then the same number with two
constexpr int kSize = 32, kBlocks = kSize / 4, kBlockBytes = 8;
constexpr GLsizei kImageBytes = 20 * 12 * 4, kPartBytes = 5 * 4 * kBlockBytes,
                  kAllBytes = kBlocks * kBlocks * kBlockBytes;
GLuint buffers[kMax], images[kMax], blocks[kMax], allBlocks[kMax];
GLuint drawn, compressed, framebuffer;

GLuint roomFor(GLsizei sizeBytes) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_PACK_BUFFER, sizeBytes, nullptr, GL_STREAM_READ);
    return buffer;
}

void makeTextures() {
    glGenTextures(1, &drawn);
    glBindTexture(GL_TEXTURE_2D, drawn);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, kSize, kSize);
    glGenTextures(1, &compressed);
    glBindTexture(GL_TEXTURE_2D, compressed);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_COMPRESSED_RED_RGTC1, kSize, kSize);
    glBindTexture(GL_TEXTURE_2D, 0);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, drawn, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

// Draws textures that only the nodes have.
void drawTextures(int frame) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glClearColor(0.4F, 0.1F, 0.03F * float(frame % 30), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glRectf(-0.9F, 0.1F * float(frame % 7) - 0.8F, 0.5F, 0.6F);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    GLuint bits = 0; // four times eight blocks of 8 bytes
    glGenTextures(1, &bits);
    glBindTexture(GL_TEXTURE_2D, bits);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RG32UI, kBlocks, kBlocks);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, bits, 0);
    const GLuint value[4] = {0x01020304U * unsigned(frame % 50), 0x00f0e0d0U + unsigned(frame), 0, 0};
    glClearBufferuiv(GL_COLOR, 0, value);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, drawn, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glCopyImageSubData(bits, GL_TEXTURE_2D, 0, 0, 0, 0, compressed, GL_TEXTURE_2D, 0, 0, 0, 0, kBlocks, kBlocks, 1);
    glBindTexture(GL_TEXTURE_2D, 0);
    glDeleteTextures(1, &bits);
}

void readTextures(int turn) {
    glBindBuffer(GL_PIXEL_PACK_BUFFER, images[turn]);
    glGetTextureSubImage(drawn, 0, 5, 9, 0, 20, 12, 1, GL_RGBA, GL_UNSIGNED_BYTE, kImageBytes, nullptr);
    glGetTextureSubImage(
        drawn, 0, 9, 2, 0, 20, 12, 1, GL_BGRA, GL_UNSIGNED_BYTE, kImageBytes,
        reinterpret_cast<void*>(intptr_t{kImageBytes})); // NOLINT(performance-no-int-to-ptr): an offset
    glBindBuffer(GL_PIXEL_PACK_BUFFER, blocks[turn]);
    glGetCompressedTextureSubImage(compressed, 0, 8, 4, 0, 20, 16, 1, kPartBytes, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, allBlocks[turn]);
    glGetCompressedTextureImage(compressed, 0, kAllBytes, nullptr);
}

void moving(int frame) {
    glClearColor(0.1F, 0.02F * float(frame % 50), 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    Sequence numbers(unsigned(frame) / 7 + 3);
    const float shift = 0.1F * float(frame % 7);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 60; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(2 * numbers.unit() - 1.3F + shift, 2 * numbers.unit() - 1);
    }
    glEnd();
}

std::uint32_t sum(const GLubyte* bytes, std::size_t count) {
    std::uint32_t hash = 2166136261U;
    for (std::size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 16777619U;
    return hash;
}

void showTextures(int turn) {
    const struct {
        GLuint buffer;
        GLsizei sizeBytes;
    } reads[] = {{images[turn], 2 * kImageBytes}, {blocks[turn], kPartBytes}, {allBlocks[turn], kAllBytes}};
    int row = 2;
    for (const auto& read : reads) {
        glBindBuffer(GL_PIXEL_PACK_BUFFER, read.buffer);
        const auto* const mapped =
            static_cast<const GLubyte*>(glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, read.sizeBytes, GL_MAP_READ_BIT));
        if (!mapped) fail("a buffer that a texture was read into can't be mapped");
        const std::uint32_t readBack = sum(mapped, std::size_t(read.sizeBytes));
        glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
        showBits(row++, readBack);
    }
}

void showRead(const Window& window, GLuint buffer) {
    const auto bytes = std::size_t(window.width()) * std::size_t(window.height()) * 4;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    const auto* const mapped =
        static_cast<const GLubyte*>(glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, GLsizeiptr(bytes), GL_MAP_READ_BIT));
    if (!mapped) fail("a buffer that was read into can't be mapped");
    const std::uint32_t readBack = sum(mapped, bytes);
    glPixelZoom(0.4F, 0.4F);
    glWindowPos2i(window.width() / 2, window.height() / 2);
    glDrawPixels(window.width(), window.height(), GL_BGRA, GL_UNSIGNED_BYTE, mapped);
    glPixelZoom(1, 1);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    showBits(1, readBack);
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {},
        [](Window& window) {
            for (int i = 0; i < kMax; ++i) {
                buffers[i] = roomFor(window.width() * window.height() * 4);
                images[i] = roomFor(2 * kImageBytes);
                blocks[i] = roomFor(kPartBytes);
                allBlocks[i] = roomFor(kAllBytes);
            }
            glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
            makeTextures();
        },
        [](Window& window, int frame) {
            moving(frame);
            const int used = frame / kTurn % 2 == 0 ? kMax : 2, since = frame % kTurn;
            glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[since % used]);
            glReadPixels(0, 0, window.width(), window.height(), GL_BGRA, GL_UNSIGNED_BYTE, nullptr);
            drawTextures(frame);
            readTextures(since % used);
            if (since + 1 < used) return;
            showRead(window, buffers[(since + 1) % used]);
            showTextures((since + 1) % used);
        });
}
