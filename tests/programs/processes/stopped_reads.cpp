// Draws and reads back repeatedly, while a script stops the processes of the session. Each reply is larger than any
// buffer on its path, so most stops interrupt a reply.
//
//   stopped_reads KIND SECONDS    KIND: pixels, buffer, texture, query, swaps
//
// At the end it prints the number of reads, of reads that differ from the first without a GL error, and of errors. The
// exit status is 0 if no read differs.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

using namespace programs;

namespace {

constexpr int kWidth = 1000, kHeight = 800;
constexpr size_t kBytes = size_t{kWidth} * kHeight * 16;

void scene(int frame) {
    glClearColor(0.1F, 0.2F, 0.3F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 30; ++i) {
        const float x = -0.9F + 0.06F * float(i), y = 0.03F * float((i * 7 + frame) % 30) - 0.6F;
        glColor3f(0.03F * float(i), 1 - 0.03F * float(i), 0.5F);
        glVertex2f(x, y);
        glVertex2f(x + 0.4F, y + 0.1F);
        glVertex2f(x + 0.1F, y + 0.5F);
    }
    glEnd();
}

class Reader {
public:
    explicit Reader(std::string kind) : kind_(std::move(kind)) {
        glGenBuffers(1, &buffer_);
        glGenTextures(1, &texture_);
        glGenQueries(1, &query_);
        glBindTexture(GL_TEXTURE_2D, texture_);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kWidth, kHeight, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        glBindTexture(GL_TEXTURE_2D, 0);
    }

    // Reads into a buffer that was filled with a pattern; bytes that are not written keep it.
    void read(std::vector<GLubyte>& into) {
        std::memset(into.data(), 0x77, into.size());
        if (kind_ == "buffer") return readBuffer(into);
        if (kind_ == "texture") return readTexture(into);
        if (kind_ == "query") return readQuery(into);
        scene(1);
        if (kind_ == "pixels") glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, into.data());
    }

private:
    void readBuffer(std::vector<GLubyte>& into) {
        scene(1);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_);
        glBufferData(GL_PIXEL_PACK_BUFFER, kBytes, nullptr, GL_STREAM_READ);
        glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, nullptr);
        if (const void* mapped = glMapBuffer(GL_PIXEL_PACK_BUFFER, GL_READ_ONLY)) {
            std::memcpy(into.data(), mapped, kBytes);
            glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
        }
        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    }

    void readTexture(std::vector<GLubyte>& into) {
        scene(1);
        glBindTexture(GL_TEXTURE_2D, texture_);
        glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, kWidth, kHeight);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, into.data());
        glBindTexture(GL_TEXTURE_2D, 0);
    }

    void readQuery(std::vector<GLubyte>& into) {
        glBeginQuery(GL_SAMPLES_PASSED, query_);
        scene(1);
        glEndQuery(GL_SAMPLES_PASSED);
        GLuint samples = 0;
        glGetQueryObjectuiv(query_, GL_QUERY_RESULT, &samples);
        std::memcpy(into.data(), &samples, sizeof samples);
    }

    std::string kind_;
    GLuint buffer_ = 0, texture_ = 0, query_ = 0;
};

} // namespace

int main(int argc, char** argv) {
    if (argc != 3) fail("usage: stopped_reads KIND SECONDS");
    const auto window = openGlxWindow({}, kWidth, kHeight);
    window->makeCurrent();
    Reader reader(argv[1]);
    std::vector<GLubyte> first(kBytes), now(kBytes);
    reader.read(first);
    std::puts("begins");
    std::fflush(stdout);
    int reads = 0, differ = 0, errors = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(argv[2]));
    while (std::chrono::steady_clock::now() < end) {
        reader.read(now);
        ++reads;
        if (glGetError() != GL_NO_ERROR) {
            ++errors;
            break; // a program with a lost reply would draw again
        }
        differ += now != first ? 1 : 0;
        window->swap();
    }
    std::printf("reads %d differ %d errors %d\n", reads, differ, errors);
    return differ == 0 ? 0 : 1;
}
