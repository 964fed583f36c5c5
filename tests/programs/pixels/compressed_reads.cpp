// Reads of compressed images whose texels come from rendering: copied from the window, copied between textures, or
// taken from a buffer that received a read. By target, by name and by unit, whole and in part, with separated blocks,
// into memory and into a buffer.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdint>
#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 32, kBlocks = kSize / 4;
constexpr GLsizei kBytes = kBlocks * kBlocks * 8, kBuffer = 4 * kBytes; // bytes of RGTC1
GLuint flat, copied, filled, cube, wide, source, packed;
int row;

void setUp(Window&) {
    for (GLuint* texture : {&flat, &copied, &filled, &cube, &wide}) glGenTextures(1, texture);
    glGenBuffers(1, &source);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, source);
    glBufferData(GL_PIXEL_PACK_BUFFER, 4 * kSize * kSize, nullptr, GL_DYNAMIC_COPY);
    glGenBuffers(1, &packed);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, packed);
    glBufferData(GL_PIXEL_PACK_BUFFER, kBuffer, nullptr, GL_STREAM_READ);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindTexture(GL_TEXTURE_2D, copied);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_COMPRESSED_RED_RGTC1, kSize, kSize);
    glTextureStorage2DEXT(wide, GL_TEXTURE_2D, 1, GL_RG32UI, kBlocks, kBlocks);
    for (GLenum face = 0; face < 6; ++face)
        glTextureImage2DEXT(cube, GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_COMPRESSED_RED_RGTC1, kSize, kSize, 0,
                            GL_RED, GL_UNSIGNED_BYTE, nullptr);
    glBindTexture(GL_TEXTURE_2D, flat);
}

void draw(int frame) {
    glClearColor(0.5F, 0.1F * float(frame), 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    Sequence numbers(unsigned(frame) + 31);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 90; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(2 * numbers.unit() - 1, 2 * numbers.unit() - 1);
    }
    glEnd();
}

void makeImages(const Window& window) {
    const int x = (window.width() - kSize) / 2, y = (window.height() - kSize) / 2;
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_COMPRESSED_RED_RGTC1, x, y, kSize, kSize, 0);
    glCopyTextureImage2DEXT(cube, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, 0, GL_COMPRESSED_RED_RGTC1, x + 3, y + 2, kSize,
                            kSize, 0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, source);
    glReadPixels(x, y, kSize, kSize, GL_RED, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, source);
    glTextureImage2DEXT(filled, GL_TEXTURE_2D, 0, GL_COMPRESSED_RED_RGTC1, kSize, kSize, 0, GL_RED, GL_UNSIGNED_BYTE,
                        nullptr);
    // Uses the bytes of a read as blocks; any bytes are valid.
    glCompressedTextureSubImage2DEXT(cube, GL_TEXTURE_CUBE_MAP_POSITIVE_X, 0, 0, 0, kSize, kSize,
                                     GL_COMPRESSED_RED_RGTC1, kBytes, nullptr);
    glTextureSubImage2DEXT(wide, GL_TEXTURE_2D, 0, 0, 0, kBlocks, kBlocks, GL_RG_INTEGER, GL_UNSIGNED_INT, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glCopyImageSubData(wide, GL_TEXTURE_2D, 0, 0, 0, 0, copied, GL_TEXTURE_2D, 0, 0, 0, 0, kBlocks, kBlocks, 1);
}

template <class Read> void show(const char* what, Read&& read) {
    std::vector<GLubyte> memory(6 * kBytes + 64, 0x5a);
    read(memory.data());
    checkNoError(what);
    std::uint32_t hash = 2166136261U;
    for (const GLubyte b : memory) hash = (hash ^ b) * 16777619U;
    showBits(row++, hash);
}

void readWhole() {
    show("target", [](void* to) { glGetCompressedTexImage(GL_TEXTURE_2D, 0, to); });
    show("sized", [](void* to) { glGetnCompressedTexImageARB(GL_TEXTURE_2D, 0, kBytes, to); });
    show("name", [](void* to) { glGetCompressedTextureImage(copied, 0, kBytes, to); });
    show("faces", [](void* to) { glGetCompressedTextureImage(cube, 0, 6 * kBytes, to); });
    show("EXT name", [](void* to) { glGetCompressedTextureImageEXT(filled, GL_TEXTURE_2D, 0, to); });
    glBindTexture(GL_TEXTURE_CUBE_MAP, cube); // by name Mesa returns all faces instead of one
    show("face", [](void* to) { glGetCompressedTexImage(GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, 0, to); });
    glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
    show("unit", [](void* to) { glGetCompressedMultiTexImageEXT(GL_TEXTURE0, GL_TEXTURE_2D, 0, to); });
}

void readParts() {
    show("part", [](void* to) { glGetCompressedTextureSubImage(flat, 0, 8, 4, 0, 12, 20, 1, 3 * 5 * 8, to); });
    show("part of faces",
         [](void* to) { glGetCompressedTextureSubImage(cube, 0, 4, 12, 1, 28, 16, 3, 7 * 4 * 3 * 8, to); });
    glPixelStorei(GL_PACK_COMPRESSED_BLOCK_WIDTH, 4);
    glPixelStorei(GL_PACK_COMPRESSED_BLOCK_HEIGHT, 4);
    glPixelStorei(GL_PACK_COMPRESSED_BLOCK_DEPTH, 1);
    glPixelStorei(GL_PACK_COMPRESSED_BLOCK_SIZE, 8);
    glPixelStorei(GL_PACK_ROW_LENGTH, kSize + 12);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 8);
    glPixelStorei(GL_PACK_SKIP_ROWS, 4);
    show("apart", [](void* to) { glGetCompressedTexImage(GL_TEXTURE_2D, 0, to); });
    for (const GLenum name :
         {GL_PACK_COMPRESSED_BLOCK_WIDTH, GL_PACK_COMPRESSED_BLOCK_HEIGHT, GL_PACK_COMPRESSED_BLOCK_DEPTH,
          GL_PACK_COMPRESSED_BLOCK_SIZE, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS})
        glPixelStorei(name, 0);
}

// Reads parts into a buffer, which is mapped after all reads. One part has separated blocks.
void readPartsIntoBuffer() {
    const auto at = [](std::uintptr_t offset) {
        return reinterpret_cast<void*>(offset);
    }; // NOLINT(performance-no-int-to-ptr): an offset
    GLuint parts = 0;
    glGenBuffers(1, &parts);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, parts);
    const std::vector<GLubyte> known(kBuffer, 0x4b);
    glBufferData(GL_PIXEL_PACK_BUFFER, kBuffer, known.data(), GL_STREAM_READ);
    glGetCompressedTextureSubImage(flat, 0, 8, 4, 0, 12, 20, 1, 3 * 5 * 8, at(8));
    glGetCompressedTextureSubImage(cube, 0, 4, 12, 1, 28, 16, 3, 7 * 4 * 3 * 8, at(256));
    glGetTextureSubImage(wide, 0, 1, 2, 0, 5, 3, 1, GL_RG_INTEGER, GL_UNSIGNED_INT, 5 * 3 * 8, at(1024));
    glPixelStorei(GL_PACK_ROW_LENGTH, 20);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 2);
    glGetTextureSubImage(filled, 0, 4, 8, 0, 16, 8, 1, GL_RED, GL_UNSIGNED_BYTE, 1000, at(1280));
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 0);
    show("parts in a buffer", [](void* to) { glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, kBuffer, to); });
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glDeleteBuffers(1, &parts);
}

void readIntoBuffer() {
    glBindBuffer(GL_PIXEL_PACK_BUFFER, packed);
    glGetCompressedTexImage(
        GL_TEXTURE_2D, 0, reinterpret_cast<void*>(std::uintptr_t(16))); // NOLINT(performance-no-int-to-ptr): an offset
    show("buffer", [](void* to) { glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 16, kBytes, to); });
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    // The nodes have these bytes, too, because they draw from them.
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, packed);
    glWindowPos2i(150, 20);
    glDrawPixels(16, kBytes / 64, GL_RGBA, GL_UNSIGNED_BYTE,
                 reinterpret_cast<const void*>(std::uintptr_t(16))); // NOLINT(performance-no-int-to-ptr)
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    std::vector<GLubyte> memory(kBytes, 0x5a);
    glGetCompressedTextureImage(flat, 0, kBytes - 1, memory.data());
    if (glGetError() != GL_INVALID_OPERATION || memory != std::vector<GLubyte>(kBytes, 0x5a))
        fail("too little room was enough");
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(argc, argv, {}, setUp, [](Window& window, int frame) {
        draw(frame);
        makeImages(window);
        row = 0;
        readWhole();
        readParts();
        readPartsIntoBuffer();
        readIntoBuffer();
    });
}
