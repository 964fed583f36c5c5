// Prints how many bytes of objects without data are not 0: new textures, renderbuffers and buffers, and invalidated
// ones. A texture made from a buffer shows the bytes that the nodes hold.
#include <cstdio>
#include <vector>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"

using namespace programs;

namespace {

constexpr int kWidth = 96, kHeight = 80;
constexpr std::size_t kBytes = std::size_t(kWidth) * kHeight * 4;

void print(const char* what, const std::vector<GLubyte>& bytes) {
    int found = 0;
    for (const GLubyte byte : bytes) {
        found += byte != 0;
    }
    checkNoError(what);
    std::printf("%s: %d of %zu bytes are not 0\n", what, found, bytes.size());
}

// Fills memory of the drawing process with a pattern, and frees it.
void fillAndFree() {
    const std::vector<GLubyte> pattern(kBytes * 4, 0xa5);
    GLuint textures[6] = {}, buffers[6] = {};
    glGenTextures(6, textures);
    glGenBuffers(6, buffers);
    for (int i = 0; i < 6; ++i) {
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexImage2D(GL_TEXTURE_2D, 0, i % 2 != 0 ? GL_RGBA32F : GL_RGBA8, kWidth, kHeight, 0, GL_RGBA,
                     i % 2 != 0 ? GL_FLOAT : GL_UNSIGNED_BYTE, pattern.data());
        glBindBuffer(GL_ARRAY_BUFFER, buffers[i]);
        glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(kBytes), pattern.data(), GL_STATIC_DRAW);
    }
    glFinish();
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glDeleteTextures(6, textures);
    glDeleteBuffers(6, buffers);
    glFinish();
}

void printTexture(const char* what, GLenum target, GLint level, std::size_t bytes, GLenum format = GL_RGBA,
                  GLenum type = GL_UNSIGNED_BYTE) {
    std::vector<GLubyte> texels(bytes, 9);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(target, level, format, type, texels.data());
    print(what, texels);
}

void testTextures() {
    GLuint textures[6] = {};
    glGenTextures(6, textures);
    fillAndFree();
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kWidth, kHeight, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    printTexture("texture", GL_TEXTURE_2D, 0, kBytes);
    fillAndFree();
    glBindTexture(GL_TEXTURE_2D, textures[1]);
    glTexStorage2D(GL_TEXTURE_2D, 3, GL_RGBA8, kWidth, kHeight);
    printTexture("texture with storage", GL_TEXTURE_2D, 0, kBytes);
    printTexture("its smaller level", GL_TEXTURE_2D, 1, kBytes / 4);
    fillAndFree();
    glBindTexture(GL_TEXTURE_2D, textures[2]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kWidth, kHeight, 0, GL_RGBA, GL_FLOAT, nullptr);
    printTexture("texture of floats", GL_TEXTURE_2D, 0, kBytes * 4, GL_RGBA, GL_FLOAT);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 8, 8, 8, 8, GL_RGBA, GL_UNSIGNED_BYTE,
                    std::vector<GLubyte>(8 * 8 * 4, 255).data());
    printTexture("written in part", GL_TEXTURE_2D, 0, kBytes);
    fillAndFree();
    glBindTexture(GL_TEXTURE_3D, textures[3]);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, 16, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    printTexture("texture in depth", GL_TEXTURE_3D, 0, std::size_t(16) * 16 * 16 * 4);
    fillAndFree();
    glBindTexture(GL_TEXTURE_2D, textures[4]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, kWidth, kHeight, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    printTexture("texture of depths", GL_TEXTURE_2D, 0, kBytes, GL_DEPTH_COMPONENT, GL_FLOAT);
    fillAndFree();
    glBindTexture(GL_TEXTURE_CUBE_MAP, textures[5]);
    for (GLenum face = GL_TEXTURE_CUBE_MAP_POSITIVE_X; face <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z; ++face) {
        glTexImage2D(face, 0, GL_RGBA8, 32, 32, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    }
    printTexture("face of a cube", GL_TEXTURE_CUBE_MAP_NEGATIVE_Z, 0, std::size_t(32) * 32 * 4);
    glDeleteTextures(6, textures);
}

void testFramebuffer(const char* what, GLsizei samples) {
    GLuint framebuffers[2] = {}, buffers[4] = {};
    fillAndFree();
    glGenFramebuffers(2, framebuffers);
    glGenRenderbuffers(4, buffers);
    for (int i = 0; i < 2; ++i) { // only the second is read
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[i]);
        glBindRenderbuffer(GL_RENDERBUFFER, buffers[2 * i]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, i == 0 ? samples : 0, GL_RGBA8, kWidth, kHeight);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[2 * i]);
        glBindRenderbuffer(GL_RENDERBUFFER, buffers[2 * i + 1]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, i == 0 ? samples : 0, GL_DEPTH24_STENCIL8, kWidth, kHeight);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, buffers[2 * i + 1]);
    }
    if (samples > 0) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers[0]);
        glBlitFramebuffer(0, 0, kWidth, kHeight, 0, 0, kWidth, kHeight, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers[1]);
    }
    std::vector<GLubyte> values(kBytes, 9);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, values.data());
    print(what, values);
    glReadPixels(0, 0, kWidth, kHeight, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, values.data());
    print("its depths and stencils", values);
    const GLenum gone[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_STENCIL_ATTACHMENT};
    glInvalidateFramebuffer(GL_FRAMEBUFFER, 2, gone);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, values.data());
    print("given up", values);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(2, framebuffers);
    glDeleteRenderbuffers(4, buffers);
}

// Prints the buffer as the nodes hold it, through a texture.
void printBuffer(const char* what, GLuint buffer) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kWidth, kHeight, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    printTexture(what, GL_TEXTURE_2D, 0, kBytes);
    glDeleteTextures(1, &texture);
}

void testBuffers() {
    const std::vector<GLubyte> pattern(kBytes, 0xa5);
    GLuint buffers[2] = {};
    glGenBuffers(2, buffers);
    fillAndFree();
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(kBytes), nullptr, GL_STREAM_DRAW);
    printBuffer("buffer", buffers[0]);
    glBufferSubData(GL_ARRAY_BUFFER, 0, 64, pattern.data());
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(kBytes) + 64, nullptr, GL_STREAM_DRAW);
    printBuffer("buffer of another size", buffers[0]);
    fillAndFree();
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    glBufferStorage(GL_ARRAY_BUFFER, GLsizeiptr(kBytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
    printBuffer("buffer with storage", buffers[1]);
    glDeleteBuffers(2, buffers);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    testTextures();
    testFramebuffer("framebuffer object", 0);
    testFramebuffer("framebuffer object with samples", 4);
    testBuffers();
    glClear(GL_COLOR_BUFFER_BIT);
    window->swap();
    return 0;
}
