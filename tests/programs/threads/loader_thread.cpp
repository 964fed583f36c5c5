// A thread with a shared context and an unused window uploads textures, buffers and programs while the main thread
// draws. Fences pass them on.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

using namespace programs;

namespace {

struct Loaded {
    GLuint texture, buffer, program;
    GLsync ready;
};

std::mutex lock_;
std::condition_variable changed;
std::deque<Loaded> loaded;

Loaded load(unsigned number) {
    Loaded item = {};
    std::vector<GLubyte> texels(32 * 32 * 4);
    Sequence numbers(number);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glGenTextures(1, &item.texture);
    glBindTexture(GL_TEXTURE_2D, item.texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 32, 32, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    GLfloat places[24];
    for (GLfloat& place : places) {
        place = numbers.unit() * 1.8F - 0.9F;
    }
    glGenBuffers(1, &item.buffer);
    glBindBuffer(GL_ARRAY_BUFFER, item.buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof places, nullptr, GL_STATIC_DRAW);
    auto* mapped = static_cast<GLfloat*>(glMapBufferRange(GL_ARRAY_BUFFER, 0, sizeof places, GL_MAP_WRITE_BIT));
    for (int i = 0; i < 24; ++i) {
        mapped[i] = places[i];
    }
    glUnmapBuffer(GL_ARRAY_BUFFER);
    const std::string fragment = "#version 330\nin vec2 at; uniform sampler2D image; out vec4 result; void main() {\n"
                                 "result = vec4(texture(image, at).rgb, 1) * " +
                                 std::to_string(0.5 + 0.1 * (number % 5)) + "; }\n";
    item.program = buildProgram({{GL_VERTEX_SHADER, "#version 330\nlayout(location=0) in vec2 place; out vec2 at; void "
                                                    "main() { at = place; gl_Position = vec4(place, 0, 1); }\n"},
                                 {GL_FRAGMENT_SHADER, fragment.c_str()}});
    item.ready = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    return item;
}

void runLoader(Window& window, int count) {
    window.makeCurrent();
    for (int i = 0; i < count; ++i) {
        const Loaded item = load(unsigned(i) + 60);
        checkNoError("in the loader thread");
        const std::lock_guard<std::mutex> guard(lock_);
        loaded.push_back(item);
        changed.notify_all();
    }
    window.release();
}

Loaded takeNext() {
    std::unique_lock<std::mutex> guard(lock_);
    changed.wait(guard, [] { return !loaded.empty(); });
    const Loaded item = loaded.front();
    loaded.pop_front();
    return item;
}

void draw(const Loaded& item) {
    glUseProgram(item.program);
    glBindTexture(GL_TEXTURE_2D, item.texture);
    glBindBuffer(GL_ARRAY_BUFFER, item.buffer);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    glDrawArrays(GL_TRIANGLES, 0, 12);
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
    GLuint vertexArray = 0;
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    std::thread loader(runLoader, std::ref(*loading), options.frames);
    std::vector<Loaded> items;
    for (int frame = 0; frame < options.frames; ++frame) {
        items.push_back(takeNext());
        if (frame % 2 == 0) {
            glWaitSync(items.back().ready, 0, GL_TIMEOUT_IGNORED);
        } else {
            glClientWaitSync(items.back().ready, 0, 10000000000ULL);
        }
        glDeleteSync(items.back().ready);
        glClearColor(0.1F, 0.2F, 0.2F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (const Loaded& item : items) {
            draw(item);
        }
        checkNoError("in the drawing thread");
        window->swap();
    }
    loader.join();
    return 0;
}
