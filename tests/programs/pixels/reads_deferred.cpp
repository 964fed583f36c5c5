// Uses of a pixel buffer between a read into it and the arrival of its bytes. It is read in every way, written, copied,
// cleared, drawn and uploaded from, deleted, or given new storage. The program makes other round trips, and uses
// another context.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

using namespace programs;

namespace {

constexpr int kWidth = 60, kHeight = 16, kX = 90, kY = 80; // across the tiles
constexpr GLsizeiptr kBytes = kWidth * kHeight * 4, kRoom = 2 * kBytes;
std::unique_ptr<Window> window, other;
GLuint texture, framebuffer, image, storage;
int row, column;

void* at(GLintptr offset) { return reinterpret_cast<void*>(offset); } // NOLINT(performance-no-int-to-ptr): an offset

void scene(int frame) {
    glClearColor(0.1F, 0.2F, 0.1F * float(frame % 9), 1);
    glClear(GL_COLOR_BUFFER_BIT);
    Sequence numbers(unsigned(frame) + 31);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 90; ++i) {
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(2 * numbers.unit() - 1, 2 * numbers.unit() - 1);
    }
    glEnd();
}

void show(const void* bytes, GLsizeiptr count) {
    std::uint32_t hash = 2166136261U;
    for (GLsizeiptr i = 0; i < count; ++i) hash = (hash ^ static_cast<const GLubyte*>(bytes)[i]) * 16777619U;
    showBits(row++, hash);
}

// Returns a bound buffer of known bytes, into which the window was read.
GLuint readAt(GLintptr offset, int dx = 0) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    const std::vector<GLubyte> known(kRoom, 0x3c);
    glBufferData(GL_PIXEL_PACK_BUFFER, kRoom, known.data(), GL_STREAM_READ);
    glReadPixels(kX + dx, kY, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, at(offset));
    return buffer;
}
void done(GLuint buffer) {
    std::vector<GLubyte> bytes(kRoom);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, kRoom, bytes.data());
    show(bytes.data(), kRoom);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glDeleteBuffers(1, &buffer);
}

void severalReads() {
    const GLuint buffer = readAt(0);
    glReadPixels(kX, kY + 20, 30, 8, GL_BGRA, GL_UNSIGNED_BYTE, at(100));
    glReadPixels(kX + 9, kY + 9, 20, 20, GL_RGB, GL_UNSIGNED_BYTE, at(kBytes));
    glPixelStorei(GL_PACK_ROW_LENGTH, 70);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 3);
    glReadPixels(-5, kY, 40, 6, GL_RGBA, GL_UNSIGNED_BYTE, at(kBytes + 1200));
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glPixelStorei(GL_PACK_SKIP_PIXELS, 0);
    const void* const mapped = glMapBuffer(GL_PIXEL_PACK_BUFFER, GL_READ_ONLY);
    show(mapped, kRoom);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    done(buffer);
}

void readByName() {
    std::vector<GLubyte> bytes(kBytes);
    GLuint buffer = readAt(16);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glGetNamedBufferSubData(buffer, 16, kBytes, bytes.data());
    show(bytes.data(), kBytes);
    done(buffer);
    buffer = readAt(16, 3);
    glGetNamedBufferSubDataEXT(buffer, 16, kBytes, bytes.data());
    show(bytes.data(), kBytes);
    done(buffer);
    buffer = readAt(16, 6);
    show(glMapNamedBufferRange(buffer, 16, kBytes, GL_MAP_READ_BIT), kBytes);
    glUnmapNamedBuffer(buffer);
    done(buffer);
}

void copyOut() {
    GLuint copy = 0, buffer = readAt(0, 5);
    glGenBuffers(1, &copy);
    glBindBuffer(GL_COPY_WRITE_BUFFER, copy);
    glBufferData(GL_COPY_WRITE_BUFFER, kRoom, nullptr, GL_STREAM_READ);
    glCopyBufferSubData(GL_PIXEL_PACK_BUFFER, GL_COPY_WRITE_BUFFER, 0, kBytes, kBytes);
    done(buffer);
    buffer = readAt(0, 6);
    glCopyNamedBufferSubData(buffer, copy, 0, 0, kBytes);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, copy); // the nodes have the copy, too
    glWindowPos2i(2, window->height() - 40);
    glDrawPixels(kWidth, 2 * kHeight, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
    done(copy);
    done(buffer);
}

void drawUploaded(GLuint buffer, GLintptr offset) {
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, at(offset));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glEnable(GL_TEXTURE_2D);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    const float x = -0.4F + 0.2F * float(column++ % 7);
    glBegin(GL_TRIANGLES);
    glTexCoord2f(0, 0);
    glVertex2f(x, 0.55F);
    glTexCoord2f(1, 0);
    glVertex2f(x + 0.18F, 0.55F);
    glTexCoord2f(0.5F, 1);
    glVertex2f(x, 0.95F);
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void upload() {
    GLuint buffer = readAt(32, 7);
    drawUploaded(buffer, 32);
    // The buffer is used for both now.
    glReadPixels(kX + 8, kY + 1, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, at(32));
    drawUploaded(buffer, 32);
    done(buffer);
    // Mapped before, and still mapped when it is first bound elsewhere.
    buffer = readAt(0, 9);
    show(glMapBuffer(GL_PIXEL_PACK_BUFFER, GL_READ_ONLY), kBytes);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    drawUploaded(buffer, 0);
    done(buffer);
}

void drawFrom() {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_PACK_BUFFER, 24 * 16, nullptr, GL_STREAM_COPY);
    glReadPixels(kX, kY + 40, 24, 1, GL_RGBA, GL_FLOAT, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexPointer(2, GL_FLOAT, 16, nullptr);
    glEnableClientState(GL_VERTEX_ARRAY);
    glColor3f(1, 0.9F, 0.2F);
    glDrawArrays(GL_TRIANGLES, 0, 24);
    glDisableClientState(GL_VERTEX_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glDeleteBuffers(1, &buffer);
    // Read by name, and from a vertex array.
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glBufferData(GL_PIXEL_PACK_BUFFER, 24 * 16, nullptr, GL_STREAM_COPY);
    glReadPixels(kX + 3, kY + 30, 24, 1, GL_RGBA, GL_FLOAT, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glVertexArrayVertexOffsetEXT(array, buffer, 2, GL_FLOAT, 16, 0);
    glEnableClientState(GL_VERTEX_ARRAY);
    glColor3f(0.1F, 0.7F, 1);
    glDrawArrays(GL_TRIANGLES, 0, 24);
    glBindVertexArray(0);
    glDeleteVertexArrays(1, &array);
    glDeleteBuffers(1, &buffer);
}

void writeOver() {
    const std::vector<GLubyte> own(300, 0x77);
    GLuint buffer = readAt(0, 11);
    glBufferSubData(GL_PIXEL_PACK_BUFFER, 200, 300, own.data());
    drawUploaded(buffer, 0);
    done(buffer);
    buffer = readAt(0, 12);
    const GLuint value = 0x01020304;
    glClearBufferSubData(GL_PIXEL_PACK_BUFFER, GL_R32UI, 64, 256, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
    drawUploaded(buffer, 0);
    done(buffer);
    buffer = readAt(0, 13);
    if (void* const mapped = glMapBufferRange(GL_PIXEL_PACK_BUFFER, 400, 100, GL_MAP_WRITE_BIT))
        std::memset(mapped, 0x19, 50);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    drawUploaded(buffer, 0);
    done(buffer);
    buffer = readAt(0, 14); // new storage, half of it read again
    const std::vector<GLubyte> all(kRoom, 0x21);
    glBufferData(GL_PIXEL_PACK_BUFFER, kRoom, all.data(), GL_STREAM_READ);
    glReadPixels(kX, kY, kWidth, kHeight / 2, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    drawUploaded(buffer, 0);
    done(buffer);
    buffer = readAt(0, 15); // an error changes nothing
    glBufferData(GL_PIXEL_PACK_BUFFER, -1, nullptr, GL_STREAM_READ);
    if (glGetError() != GL_INVALID_VALUE) fail("storage of -1 bytes is no error");
    done(buffer);
}

void deleteEarly() {
    GLuint buffer = readAt(0, 16);
    glDeleteBuffers(1, &buffer);
    GLuint next = 0;
    glGenBuffers(1, &next); // the same name
    glBindBuffer(GL_PIXEL_PACK_BUFFER, next);
    const std::vector<GLubyte> all(kRoom, 0x42);
    glBufferData(GL_PIXEL_PACK_BUFFER, kRoom, all.data(), GL_STREAM_READ);
    glReadPixels(kX, kY + 3, 5, 5, GL_RGBA, GL_UNSIGNED_BYTE, at(20));
    done(next);
}

void queryBetween() {
    const GLuint buffer = readAt(0, 17), second = readAt(0, 18);
    std::vector<GLubyte> bytes(kBytes);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glReadPixels(kX + 19, kY, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    show(bytes.data(), kBytes);
    GLuint query = 0, samples = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    glRectf(0.1F, -0.1F, 0.2F, 0.1F);
    glEndQuery(GL_SAMPLES_PASSED);
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &samples);
    glDeleteQueries(1, &query);
    showBits(row++, samples);
    done(second);
    done(buffer);
}

// Reads textures, framebuffer objects, and with functions that take the buffer size.
void readOthers() {
    GLuint buffer = readAt(0, 20);
    glBindTexture(GL_TEXTURE_2D, image);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kX, kY, 32, 16);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, at(64));
    done(buffer);
    buffer = readAt(0, 21);
    glGetTextureSubImage(image, 0, 3, 2, 0, 11, 7, 1, GL_RGBA, GL_UNSIGNED_BYTE, 11 * 7 * 4, at(128));
    glGetnTexImageARB(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, 32 * 16 * 3, at(kBytes));
    done(buffer);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glClearColor(0.3F, 0.9F, 0.1F, 0.5F);
    glClear(GL_COLOR_BUFFER_BIT);
    glRectf(-0.5F, -0.3F, 0.2F, 0.6F);
    buffer = readAt(0, -kX - 10);
    glReadPixels(4, 4, 150, 12, GL_RGBA, GL_UNSIGNED_BYTE, at(16)); // wider than the object
    glClear(GL_COLOR_BUFFER_BIT);                                   // after the read
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    done(buffer);
    buffer = readAt(0, 22);
    glReadnPixelsARB(kX, kY, 10, 10, GL_RGBA, GL_UNSIGNED_BYTE, 400, at(40));
    glGetPolygonStipple(static_cast<GLubyte*>(at(8)));
    done(buffer);
}

// Makes overlapping reads into one buffer: the last read wins.
void readOverOthers() {
    const GLuint buffer = readAt(0, 28);
    glBindTexture(GL_TEXTURE_2D, image);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kX + 2, kY + 1, 32, 16);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, at(64));
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kX + 40, kY - 9, 32, 16);
    glGetTextureSubImage(image, 0, 3, 2, 0, 11, 7, 1, GL_RGBA, GL_UNSIGNED_BYTE, 11 * 7 * 4, at(128));
    glGetnTexImageARB(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, 32 * 16 * 3, at(300));
    glPixelStorei(GL_PACK_ROW_LENGTH, 70);
    glReadnPixelsARB(kX, kY, 30, 5, GL_RGBA, GL_UNSIGNED_BYTE, kRoom, at(1000));
    glGetTextureSubImage(image, 0, 0, 0, 0, 20, 9, 1, GL_BGRA, GL_UNSIGNED_BYTE, kRoom,
                         at(1100)); // between those rows, too
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    done(buffer);
}

void mistakes() {
    const GLuint buffer = readAt(0, 23);
    const auto expect = [](GLenum wanted, const char* what) {
        if (const GLenum error = glGetError(); error != wanted)
            fail("%s: error %#x instead of %#x", what, error, wanted);
    };
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, at(kBytes + 4));
    expect(GL_INVALID_OPERATION, "behind the buffer");
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_TEXTURE_2D, nullptr);
    expect(GL_INVALID_ENUM, "a type that is none");
    glReadPixels(0, 0, -1, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    expect(GL_INVALID_VALUE, "a width below 0");
    glMapBuffer(GL_PIXEL_PACK_BUFFER, GL_READ_ONLY);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    expect(GL_INVALID_OPERATION, "a mapped buffer");
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    done(buffer);
}

// Keeps the buffer mapped: it shows the pixels once GL has finished.
void mapForGood() {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const std::vector<GLubyte> known(kRoom, 0x5e);
    glBufferStorage(GL_PIXEL_PACK_BUFFER, kRoom, known.data(), kAccess);
    glReadPixels(kX, kY, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    const void* const mapped = glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, kRoom, kAccess);
    show(mapped, kBytes);
    glReadPixels(kX + 24, kY, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, at(kBytes));
    glFinish();
    show(mapped, kRoom);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    done(buffer);
}

// Makes more reads than may be outstanding at once, and reads pixel by pixel.
void many() {
    GLuint buffers[80];
    glGenBuffers(80, buffers);
    for (int i = 0; i < 80; ++i) {
        glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[i]);
        glBufferData(GL_PIXEL_PACK_BUFFER, 64, nullptr, GL_STREAM_READ);
        if (i % 3 == 0) glRectf(-0.9F, -0.9F, -0.8F + 0.01F * float(i), -0.8F);
        glReadPixels(kX - 70 + i, kY - 60, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    }
    std::vector<GLubyte> bytes(80 * 64);
    for (int i = 79; i >= 0; --i) glGetNamedBufferSubData(buffers[i], 0, 64, bytes.data() + std::size_t(i) * 64);
    show(bytes.data(), GLsizeiptr(bytes.size()));
    glDeleteBuffers(80, buffers);
    const GLuint buffer = readAt(0, 25);
    for (int i = 0; i < 100; ++i) glReadPixels(kX + i, kY + i / 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, at(8 * i));
    done(buffer);
}

// Lets the other context of the share group map the buffer, read into it, and delete it.
void share() {
    if (!other) { // alone in the first frame
        other = openGlxWindow({}, 32, 32, window.get());
        return window->makeCurrent();
    }
    const GLuint buffer = readAt(0, 26), second = readAt(0, 27);
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 1000000000);
    glDeleteSync(fence);
    std::vector<GLubyte> bytes(kBytes);
    other->makeCurrent();
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, kBytes, bytes.data());
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glDeleteBuffers(1, &second); // still bound in the first context
    window->makeCurrent();
    show(bytes.data(), kBytes);
    done(buffer);
}

void setUp() {
    glGenBuffers(1, &storage);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, storage);
    glBufferData(GL_SHADER_STORAGE_BUFFER, 64, nullptr, GL_STREAM_READ);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kWidth, kHeight, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenTextures(1, &image);
    glBindTexture(GL_TEXTURE_2D, image);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 32, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    GLuint target = 0;
    glGenTextures(1, &target);
    glBindTexture(GL_TEXTURE_2D, target);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 128, 64, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindTexture(GL_TEXTURE_2D, 0);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    window = openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    setUp();
    constexpr void (*kParts[])() = {severalReads, readByName,  copyOut,      upload,     drawFrom,
                                    writeOver,    deleteEarly, queryBetween, readOthers, readOverOthers,
                                    mistakes,     mapForGood,  many,         share};
    for (int frame = 0; frame < options.frames; ++frame) {
        scene(frame);
        row = column = 0;
        // From now on any buffer may hold data that only shaders have written.
        if (frame == 2) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, storage);
        for (const auto part : kParts) {
            part();
            checkNoError("after reads into buffers");
        }
        window->swap();
    }
    other.reset();
    return 0;
}
