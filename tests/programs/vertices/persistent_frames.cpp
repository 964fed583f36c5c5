// Thousands of small frames, each drawn into its own cell from memory that stays mapped:
//   - rings with and without fences, flushed ranges, maps without coherence;
//   - writes of another thread and of system calls, and writes between two draws;
//   - results of shaders and reads of pixels in mappings, read after a fence.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>
#include <unistd.h>

using namespace programs;

namespace {

constexpr int kColumns = 40, kRows = 25, kRounds = kColumns * kRows;
constexpr GLbitfield kCoherent = GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;

struct Vertex {
    GLfloat x, y, color[3];
};
enum Source { Colors, Tint, Texel, Counter };

struct Map {
    GLuint buffer = 0;
    GLubyte* memory = nullptr;
    GLsizeiptr size = 0, next = 0;

    void make(GLsizeiptr bytes, GLbitfield access, GLbitfield extra = 0) {
        size = bytes;
        glCreateBuffers(1, &buffer);
        glNamedBufferStorage(buffer, bytes, nullptr, access);
        memory = static_cast<GLubyte*>(glMapNamedBufferRange(buffer, 0, bytes, access | extra));
        if (memory == nullptr) {
            fail("no persistent mapping");
        }
    }
    // Returns the next bytes that no draw reads yet.
    GLsizeiptr take(GLsizeiptr bytes) {
        if (next + bytes > size) {
            glFinish();
            next = 0;
        }
        next += bytes;
        return next - bytes;
    }
};

// A thread that writes to a given address, and reports when it is done.
class OtherThread {
public:
    OtherThread() : thread_([this] { run(); }) {}
    ~OtherThread() {
        write(nullptr, nullptr, 0);
        thread_.join();
    }
    void write(void* to, const void* from, std::size_t bytes) {
        std::unique_lock<std::mutex> held(mutex_);
        to_ = to, from_ = from, bytes_ = bytes, due_ = true;
        changed_.notify_all();
        changed_.wait(held, [this] { return !due_; });
    }

private:
    void run() {
        std::unique_lock<std::mutex> held(mutex_);
        for (bool on = true; on;) {
            changed_.wait(held, [this] { return due_; });
            on = to_ != nullptr;
            if (on) {
                std::memcpy(to_, from_, bytes_);
            }
            due_ = false;
            changed_.notify_all();
        }
    }
    std::mutex mutex_;
    std::condition_variable changed_;
    void* to_ = nullptr;
    const void* from_ = nullptr;
    std::size_t bytes_ = 0;
    bool due_ = false;
    std::thread thread_;
};

GLuint program, compute, vertexArray, texture;
Map ring, stream, flushed, loose, uniforms, pixels, results, counter, read;
constexpr int kRegions = 4;
GLsync fences[kRegions];
int pipeEnds[2];

struct Cell {
    Vertex vertices[6];
    Cell(int round, int frame, float from = 0, float to = 1) {
        const float x = float(round % kColumns) / kColumns * 2 - 1, y = float(round / kColumns) / kRows * 2 - 1;
        const float left = x + from * 2 / kColumns, right = x + to * 1.9F / kColumns, top = y + 1.9F / kRows;
        Sequence numbers(unsigned(round * 31 + frame * 7919 + int(from * 100)));
        const GLfloat corners[6][2] = {{left, y}, {right, y}, {right, top}, {left, y}, {right, top}, {left, top}};
        for (int i = 0; i < 6; ++i) {
            vertices[i] = {corners[i][0], corners[i][1], {numbers.unit(), numbers.unit(), numbers.unit()}};
        }
    }
};

void bind(const Map& map, Source source) {
    glVertexArrayVertexBuffer(vertexArray, 0, map.buffer, 0, sizeof(Vertex));
    glProgramUniform1i(program, 0, source);
}
void drawAt(GLsizeiptr offset) { glDrawArrays(GL_TRIANGLES, GLint(offset / GLsizeiptr(sizeof(Vertex))), 6); }

void wait(GLsync& fence, bool poll) {
    if (fence == nullptr) {
        return;
    }
    GLint status = GL_UNSIGNALED;
    for (int i = 0; poll && status != GL_SIGNALED && i < 1000000; ++i) {
        glFlush();
        glGetSynciv(fence, GL_SYNC_STATUS, 1, nullptr, &status);
    }
    if (!poll) {
        glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 10000000000ULL);
    }
    glDeleteSync(fence);
    fence = nullptr;
}

void ringWithFences(const Cell& cell, int round) {
    const int region = round % kRegions;
    wait(fences[region], false);
    const GLsizeiptr at = region * 1024 * GLsizeiptr(sizeof(Vertex));
    std::memcpy(ring.memory + at, &cell, sizeof cell);
    bind(ring, Colors);
    drawAt(at);
    fences[region] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

// Makes two draws with a write between them, and no call to GL.
void streamWithout(int round, int frame) {
    bind(stream, Colors);
    const GLsizeiptr at = stream.take(2 * sizeof(Cell));
    const Cell left(round, frame, 0, 0.4F), right(round, frame, 0.5F, 1);
    std::memcpy(stream.memory + at, &left, sizeof left);
    drawAt(at);
    std::memcpy(stream.memory + at + sizeof left, &right, sizeof right);
    drawAt(at + GLsizeiptr(sizeof left));
}

void flushRange(const Cell& cell) {
    const GLsizeiptr at = flushed.take(sizeof cell);
    std::memcpy(flushed.memory + at, &cell, sizeof cell);
    glFlushMappedNamedBufferRange(flushed.buffer, at, sizeof cell);
    bind(flushed, Colors);
    drawAt(at);
}

void withoutCoherence(const Cell& cell) {
    const GLsizeiptr at = loose.take(sizeof cell);
    std::memcpy(loose.memory + at, &cell, sizeof cell);
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    bind(loose, Colors);
    drawAt(at);
}

void uniformBlock(const Cell& cell) {
    const GLsizeiptr place = uniforms.take(256), at = stream.take(sizeof cell);
    std::memcpy(uniforms.memory + place, cell.vertices[0].color, 12);
    std::memcpy(stream.memory + at, &cell, sizeof cell);
    glBindBufferRange(GL_UNIFORM_BUFFER, 0, uniforms.buffer, place, 256);
    bind(stream, Tint);
    drawAt(at);
}

void otherWriters(const Cell& cell, OtherThread& other, bool byThread) {
    const GLsizeiptr at = stream.take(sizeof cell);
    if (byThread) {
        other.write(stream.memory + at, &cell, sizeof cell);
    } else if (::write(pipeEnds[1], &cell, sizeof cell) != sizeof cell ||
               ::read(pipeEnds[0], stream.memory + at, sizeof cell) != sizeof cell) {
        fail("a system call can't write into the mapping");
    }
    bind(stream, Colors);
    drawAt(at);
}

void textureFromMap(const Cell& cell) {
    const GLsizeiptr place = pixels.take(64), at = stream.take(sizeof cell);
    std::memcpy(pixels.memory + place, cell.vertices[1].color, 12);
    std::memcpy(stream.memory + at, &cell, sizeof cell);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, pixels.buffer);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGB, GL_FLOAT, reinterpret_cast<void*>(place));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    bind(stream, Texel);
    drawAt(at);
}

// Draws a shader's result, a copy of it and a window pixel of the earlier drawing as colours.
void resultsOfTheGl(Cell cell, int round) {
    glUseProgram(compute);
    glUniform1ui(0, GLuint(round));
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glCopyNamedBufferSubData(results.buffer, read.buffer, 4, 4, 4);
    glUseProgram(program);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, read.buffer);
    glReadPixels(1, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, reinterpret_cast<void*>(64));
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    wait(fence, round % 20 < 10);
    GLuint values[2];
    std::memcpy(&values[0], results.memory, 4);
    std::memcpy(&values[1], read.memory + 4, 4);
    for (Vertex& v : cell.vertices) {
        v.color[0] = float(values[0] % 251) / 250;
        v.color[1] = float(values[1] % 241) / 240;
        v.color[2] = float(read.memory[64]) / 255;
    }
    const GLsizeiptr at = stream.take(sizeof cell);
    std::memcpy(stream.memory + at, &cell, sizeof cell);
    bind(stream, Colors);
    drawAt(at);
}

// Lets the compute shader count up from the program's value, which is the same every time.
void counterFromZero(const Cell& cell, int round) {
    glFinish();
    std::memset(counter.memory, 0, 4);
    glUseProgram(compute);
    glUniform1ui(0, GLuint(round));
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glUseProgram(program);
    const GLsizeiptr at = stream.take(sizeof cell);
    std::memcpy(stream.memory + at, &cell, sizeof cell);
    bind(stream, Counter);
    drawAt(at);
}

void makeProgramsAndState() {
    program = buildProgram(
        {{GL_VERTEX_SHADER, R"(#version 450
layout(location=0) in vec2 place; layout(location=1) in vec3 color; layout(location=0) uniform int source;
layout(std140, binding=0) uniform Block { vec4 tint; }; layout(std430, binding=1) buffer Count { uint count; };
layout(binding=0) uniform sampler2D texel; flat out vec3 shade;
void main() { gl_Position = vec4(place, 0, 1); shade = color; if (source == 1) shade = tint.rgb;
if (source == 2) shade = texelFetch(texel, ivec2(0), 0).rgb; if (source == 3) shade = vec3(float(count & 63u) / 63.0, color.gb); })"},
         {GL_FRAGMENT_SHADER,
          "#version 450\nflat in vec3 shade; out vec4 result; void main() { result = vec4(shade, 1); }\n"}});
    compute = buildProgram({{GL_COMPUTE_SHADER, R"(#version 450
layout(local_size_x=8) in; layout(location=0) uniform uint round; layout(std430, binding=1) buffer Count { uint count; };
layout(std430, binding=2) buffer Results { uint values[]; };
void main() { atomicAdd(count, round & 7u); if (gl_LocalInvocationIndex < 2u) values[gl_LocalInvocationIndex] = round * (7919u + gl_LocalInvocationIndex); })"}});
    glCreateVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    for (GLuint i = 0; i < 2; ++i) {
        glEnableVertexArrayAttrib(vertexArray, i);
        glVertexArrayAttribFormat(vertexArray, i, i == 0 ? 2 : 3, GL_FLOAT, GL_FALSE, i == 0 ? 0 : 8);
        glVertexArrayAttribBinding(vertexArray, i, 0);
    }
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_RGB32F, 1, 1);
    glBindTextureUnit(0, texture);
    glBindTexture(GL_TEXTURE_2D, texture);
}

void setUp() {
    makeProgramsAndState();
    ring.make(kRegions * 1024 * sizeof(Vertex), GL_MAP_WRITE_BIT | kCoherent);
    stream.make(sizeof(Cell) * 4096, GL_MAP_WRITE_BIT | kCoherent);
    flushed.make(sizeof(Cell) * 600, GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT, GL_MAP_FLUSH_EXPLICIT_BIT);
    loose.make(sizeof(Cell) * 600, GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT);
    uniforms.make(1 << 17, GL_MAP_WRITE_BIT | kCoherent);
    pixels.make(1 << 17, GL_MAP_WRITE_BIT | kCoherent);
    results.make(256, GL_MAP_READ_BIT | kCoherent);
    counter.make(256, GL_MAP_WRITE_BIT | kCoherent);
    read.make(256, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | kCoherent);
    glBindBufferRange(GL_UNIFORM_BUFFER, 0, uniforms.buffer, 0, 256);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, counter.buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, results.buffer);
    if (pipe(pipeEnds) != 0) {
        fail("no pipe");
    }
}

void drawRound(int round, int frame, OtherThread& other) {
    const Cell cell(round, frame);
    switch (round % 10) {
    case 0: return ringWithFences(cell, round / 10);
    case 1: return streamWithout(round, frame);
    case 2: return flushRange(cell);
    case 3: return withoutCoherence(cell);
    case 4: return uniformBlock(cell);
    case 5: return otherWriters(cell, other, true);
    case 6: return otherWriters(cell, other, false);
    case 7: return textureFromMap(cell);
    case 8: return resultsOfTheGl(cell, round);
    default: return counterFromZero(cell, round);
    }
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 5};
    OtherThread other;
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [&other](Window&, int frame) {
            glClearColor(0.1F, 0.12F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            glUseProgram(program);
            for (int round = 0; round < kRounds; ++round) {
                drawRound(round, frame, other);
            }
        });
}
