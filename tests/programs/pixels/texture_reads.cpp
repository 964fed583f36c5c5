// Reads of parts of textures: cube faces, layers, boxes, by name, by target and by unit, into memory and into a buffer.
// Their texels are copies of the window, made in every way, also with EXT_direct_state_access.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 32;
GLuint cube, layers, volume, line, flat, depth, packed;

std::uint32_t sum(const std::vector<GLubyte>& bytes) {
    std::uint32_t hash = 2166136261U;
    for (const GLubyte b : bytes) hash = (hash ^ b) * 16777619U;
    return hash;
}

void allocate(GLenum target, GLuint& texture, int width, int height, int images) {
    glGenTextures(1, &texture);
    glBindTexture(target, texture);
    if (target == GL_TEXTURE_CUBE_MAP) {
        for (GLenum face = 0; face < 6; ++face)
            glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA8, width, height, 0, GL_RGBA,
                         GL_UNSIGNED_BYTE, nullptr);
    } else if (images > 0) {
        glTexImage3D(target, 0, GL_RGBA8, width, height, images, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    } else if (height == 1) {
        glTexImage1D(target, 0, GL_RGBA8, width, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    } else {
        glTexImage2D(target, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    }
    glBindTexture(target, 0);
}

void setUp(Window&) {
    allocate(GL_TEXTURE_CUBE_MAP, cube, kSize, kSize, 0);
    allocate(GL_TEXTURE_2D_ARRAY, layers, kSize, kSize, 3);
    allocate(GL_TEXTURE_3D, volume, kSize, kSize, 2);
    allocate(GL_TEXTURE_1D, line, 128, 1, 0);
    allocate(GL_TEXTURE_2D, flat, kSize, kSize, 0);
    glGenTextures(1, &depth);
    glGenBuffers(1, &packed);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, packed);
    glBufferData(GL_PIXEL_PACK_BUFFER, 4 * kSize * kSize, nullptr, GL_DYNAMIC_READ);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

// Draws a different colour and depth at every pixel.
void pattern(int frame) {
    glClearColor(0.1F, 0.2F, 0.2F * float(frame), 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    Sequence numbers(unsigned(frame) + 5);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 120; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex3f(2 * numbers.unit() - 1, 2 * numbers.unit() - 1, 2 * numbers.unit() - 1);
    }
    glEnd();
    glDisable(GL_DEPTH_TEST);
    glPixelStorei(GL_PACK_ALIGNMENT, 1 << frame % 4);
}

void copyOut(const Window& window) {
    const int right = window.width() - kSize, top = window.height() - kSize, x = right / 2, y = top / 2;
    glBindTexture(GL_TEXTURE_CUBE_MAP, cube);
    glCopyTexSubImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_Y, 0, 0, 0, x, y, kSize, kSize);
    glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
    glCopyTextureSubImage2DEXT(cube, GL_TEXTURE_CUBE_MAP_NEGATIVE_Z, 0, 4, 4, x - 9, y - 3, 24, 24);
    glCopyTextureSubImage3DEXT(layers, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 2, x, y, kSize, kSize);
    glCopyTextureSubImage3D(volume, 0, 1, 2, 1, x + 2, y + 2, 20, 20);
    glCopyTextureImage1DEXT(line, GL_TEXTURE_1D, 0, GL_RGBA8, 20, y + 16, 128, 0);
    glCopyMultiTexImage1DEXT(GL_TEXTURE1, GL_TEXTURE_1D, 0, GL_RGB8, 30, y + 17, 64, 0);
    glBindTexture(GL_TEXTURE_2D, flat);
    glCopyMultiTexSubImage2DEXT(GL_TEXTURE0, GL_TEXTURE_2D, 0, 0, 0, x, y - 5, kSize, kSize);
    glBindTexture(GL_TEXTURE_2D, 0);
    glEnable(GL_RASTERIZER_DISCARD); // affects only draws
    glCopyTextureImage2DEXT(depth, GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, x, y, kSize, kSize, 0);
    glDisable(GL_RASTERIZER_DISCARD);
}

void showReads() {
    std::vector<GLubyte> bytes(4 * kSize * kSize * 6);
    const auto size = static_cast<GLsizei>(bytes.size());
    int row = 0;
    const auto show = [&] {
        showBits(row++, sum(bytes));
        bytes.assign(bytes.size(), 0x55);
    };
    bytes.assign(bytes.size(), 0x55);
    glGetTextureSubImage(cube, 0, 3, 5, 2, 20, 11, 4, GL_RGBA, GL_UNSIGNED_BYTE, size, bytes.data());
    show();
    glPixelStorei(GL_PACK_ROW_LENGTH, 40);
    glPixelStorei(GL_PACK_SKIP_ROWS, 3);
    glGetTextureSubImage(layers, 0, 7, 1, 1, 9, 30, 2, GL_BGR, GL_UNSIGNED_BYTE, size, bytes.data());
    show();
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glPixelStorei(GL_PACK_SKIP_ROWS, 0);
    glGetTextureSubImage(volume, 0, 0, 0, 1, kSize, kSize, 1, GL_RGBA, GL_UNSIGNED_SHORT, size, bytes.data());
    show();
    glGetTextureSubImage(line, 0, 40, 0, 0, 61, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, size, bytes.data());
    show();
    glGetTextureImage(cube, 0, GL_RGBA, GL_UNSIGNED_BYTE, size, bytes.data());
    show();
    glGetTextureImageEXT(cube, GL_TEXTURE_CUBE_MAP_NEGATIVE_Z, 0, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    show();
    glGetTextureImageEXT(depth, GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, bytes.data());
    show();
    glGetMultiTexImageEXT(GL_TEXTURE1, GL_TEXTURE_1D, 0, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
    show();
    glBindBuffer(GL_PIXEL_PACK_BUFFER, packed);
    glGetTextureSubImage(flat, 0, 2, 3, 0, 25, 21, 1, GL_RGBA, GL_UNSIGNED_BYTE, 4 * kSize * kSize, nullptr);
    glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, 4 * 25 * 21, bytes.data());
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    show();
}

// Reads with a target that is not the texture's: an error, and the memory is not accessed.
void mistake() {
    const auto* nowhere = reinterpret_cast<const void*>(16); // NOLINT(performance-no-int-to-ptr): GL must not read it
    glTextureImage2DEXT(cube, GL_TEXTURE_2D, 0, GL_RGBA8, 64, 64, 0, GL_RGBA, GL_UNSIGNED_BYTE, nowhere);
    if (glGetError() != GL_INVALID_OPERATION) fail("a cube map was taken for a flat texture");
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(argc, argv, {}, setUp, [](Window& window, int frame) {
        pattern(frame);
        copyOut(window);
        showReads();
        mistake();
    });
}
