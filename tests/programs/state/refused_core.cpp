// Calls that GL rejects in a core context leave their error and have no other effect. These are calls of the
// compatibility profile, unused names, missing draw buffers, and missing memory after another error. Shader writes use
// no names, and the source of a buffer clear is found.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint writing;

unsigned error() {
    const GLenum first = glGetError();
    while (glGetError() != GL_NO_ERROR) {}
    return first;
}

void callOldCommands() {
    const GLfloat four[4] = {};
    glVertex4fv(four);
    showBits(0, error());
    glVertex2i(1, 2);
    showBits(1, error());
    glVertexP3ui(GL_UNSIGNED_INT_2_10_10_10_REV, 7);
    showBits(2, error());
    glEvalCoord1f(0.5F);
    showBits(3, error());
    glEvalPoint2(1, 1);
    showBits(4, error());
    glArrayElement(0);
    showBits(5, error());
    glRecti(0, 0, 3, 3);
    showBits(6, error());
    glBegin(GL_TRIANGLES);
    glVertexAttrib4fv(0, four);
    showBits(7, error());
    glEnd();
    showBits(8, error());
}

// Makes rejected binds: the window and its draw buffer stay bound.
void bindNothing() {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDeleteFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    showBits(10, error());
    const GLenum wrong[] = {GL_FRONT, GL_COLOR_ATTACHMENT31};
    glNamedFramebufferDrawBuffers(0, 2, wrong);
    showBits(11, error());
    glDrawBuffers(2, wrong);
    showBits(12, error());
    glDrawBuffer(GL_COLOR_ATTACHMENT0);
    showBits(13, error());
    fillRectangle(140, 20, 60, 30, {0.9F, 0.5F, 0.1F});
    // GL accepts an empty list of draw buffers.
    glNamedFramebufferDrawBuffers(0, 0, nullptr);
    fillRectangle(150, 25, 10, 10, {0.1F, 0.5F, 0.9F});
    glDrawBuffer(GL_BACK);
    glDrawBuffers(0, nullptr);
    fillRectangle(170, 25, 10, 10, {0.1F, 0.5F, 0.9F});
    glDrawBuffer(GL_BACK);
}

// Checks that the shader writes to the buffer that was bound before.
void writeWords(GLbitfield flags, int row) {
    GLuint buffers[3] = {};
    glGenBuffers(2, buffers);
    const GLuint zeros[8] = {};
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[0]);
    glBufferStorage(GL_SHADER_STORAGE_BUFFER, sizeof zeros, zeros, flags | GL_MAP_READ_BIT);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0]);
    glDeleteBuffers(1, &buffers[1]);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[1]);
    showBits(row, error());
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[1]);
    showBits(row + 1, error());
    glUseProgram(writing);
    glDispatchCompute(8, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    GLubyte bytes[22] = {}; // from any offset to any offset
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 5, sizeof bytes, bytes);
    showBits(row + 2, std::uint32_t{bytes[3]} << 24U | std::uint32_t{bytes[7]} << 16U | std::uint32_t{bytes[19]} << 8U |
                          bytes[21]);
    GLuint readBack[8] = {};
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof readBack, readBack);
    showBits(row + 2, readBack[7]);
    if (const void* const mapped = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, sizeof readBack, GL_MAP_READ_BIT)) {
        showBits(row + 3, static_cast<const GLuint*>(mapped)[6]);
        glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
    }
    glGenBuffers(1, &buffers[2]);
    showBits(row + 4, buffers[2] - buffers[0]);
    glDeleteBuffers(1, &buffers[0]);
    glDeleteBuffers(1, &buffers[2]);
}

// Clears a buffer with a word whose position the unpack state selects.
void clearWithSkippedWords() {
    const GLuint words[] = {11, 22, 33, 44};
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof words, nullptr, GL_DYNAMIC_COPY);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 2);
    glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, words);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 8, 4, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    GLuint readBack[4] = {};
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof readBack, readBack);
    showBits(30, readBack[1]);
    showBits(31, readBack[2]);
    glDeleteBuffers(1, &buffer);
}

// Makes mipmaps, for whose format Mesa has no memory, after another error. The earlier error hides the one about
// memory.
void makeMipmapBehindAnError() {
    const GLubyte blocks[16] = {};
    GLuint textures[2] = {};
    glGenTextures(2, textures);
    glBindTexture(GL_TEXTURE_1D, textures[1]);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glCompressedTexImage2D(GL_TEXTURE_2D, 0, GL_COMPRESSED_RGBA8_ETC2_EAC, 4, 4, 0, 16, blocks);
    glBindTexture(GL_TEXTURE_2D, textures[1]);
    glGenerateMipmap(GL_TEXTURE_2D);
    showBits(32, error());
    GLubyte pixel[4] = {};
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel); // by then the nodes have reported the failure
    showBits(33, error());
    glGenerateMipmap(GL_TEXTURE_2D);
    showBits(34, error());
    glDeleteTextures(2, textures);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 5};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            GLuint vertexArray = 0;
            glGenVertexArrays(1, &vertexArray);
            glBindVertexArray(vertexArray);
            writing = buildProgram({{GL_COMPUTE_SHADER, R"(#version 430
                layout(local_size_x = 1) in; layout(std430, binding = 0) buffer Words { uint words[]; };
                void main() { words[gl_GlobalInvocationID.x] += gl_GlobalInvocationID.x * 5u + 1u; })"}});
        },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.2F, 0.1F * float(frame), 1);
            glClear(GL_COLOR_BUFFER_BIT);
            callOldCommands();
            bindNothing();
            writeWords(GL_DYNAMIC_STORAGE_BIT, 15);
            writeWords(GL_MAP_WRITE_BIT, 20);
            glPixelStorei(GL_UNPACK_SKIP_PIXELS, 1);
            writeWords(0, 25);
            glPixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
            clearWithSkippedWords();
            makeMipmapBehindAnError();
        });
}
