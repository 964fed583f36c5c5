// Buffers that stay mapped while they are drawn from: coherent ones written between two draws of one frame, and flushed
// ones. Also one ring of three regions with fences, and a mapping that only a texture buffer and a uniform block read.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>

using namespace programs;

namespace {

constexpr int kRegions = 3;
constexpr GLsizeiptr kRegionBytes = 4096;
GLuint program, vertexArray;
GLuint coherentBuffer, flushedBuffer, ringBuffer, uniformBuffer, texelBuffer, texelTexture;
GLfloat *coherent, *flushed, *ring, *uniforms;
GLubyte* texels;
GLsync fences[kRegions];

GLfloat* mapPersistently(GLuint buffer, GLsizeiptr size, GLbitfield extra) {
    const GLbitfield coherency = GL_MAP_COHERENT_BIT & extra;
    const GLbitfield access = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT;
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
    glBufferStorage(GL_COPY_WRITE_BUFFER, size, nullptr, access | coherency);
    auto* memory = static_cast<GLfloat*>(glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, size, access | extra));
    if (memory == nullptr) {
        fail("no persistent mapping");
    }
    return memory;
}

// Writes the corners of a fan of eight triangles around (x, y).
void writeShape(GLfloat* out, unsigned seed, float x, float y) {
    Sequence numbers(seed);
    for (int i = 0; i < 24; ++i) {
        out[i * 2] = x + (i % 3 == 0 ? 0 : numbers.unit() * 0.3F - 0.15F);
        out[i * 2 + 1] = y + (i % 3 == 0 ? 0 : numbers.unit() * 0.4F - 0.2F);
    }
}

void drawFrom(GLuint buffer, GLintptr offset) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, reinterpret_cast<void*>(offset));
    glDrawArrays(GL_TRIANGLES, 0, 24);
}

void drawCoherent(int frame) {
    for (int step = 0; step < 3; ++step) {
        // After the region drawn last: each step has its own region, so no draw reads during the write.
        GLfloat* place = coherent + (frame % 2) * 512 + step * 64;
        if (step == 0) {
            glFinish();
        }
        writeShape(place, unsigned(frame * 10 + step), -0.7F + float(step) * 0.35F, 0.7F);
        drawFrom(coherentBuffer, (place - coherent) * 4);
    }
    // Writes to the same region again, after its draws have finished.
    glFinish();
    writeShape(coherent, unsigned(frame) + 77, 0.6F, 0.7F);
    drawFrom(coherentBuffer, 0);
    glFinish();
}

void drawFlushed(int frame) {
    glFinish();
    writeShape(flushed + 128, unsigned(frame) + 300, -0.6F, 0.1F);
    glBindBuffer(GL_COPY_WRITE_BUFFER, flushedBuffer);
    glFlushMappedBufferRange(GL_COPY_WRITE_BUFFER, 512, 192);
    drawFrom(flushedBuffer, 512);
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
}

void drawRing(int frame) {
    const int region = frame % kRegions;
    if (fences[region] != nullptr) {
        glClientWaitSync(fences[region], GL_SYNC_FLUSH_COMMANDS_BIT, 10000000000ULL);
        glDeleteSync(fences[region]);
    }
    writeShape(ring + region * kRegionBytes / 4, unsigned(frame) + 500, 0, 0.1F);
    drawFrom(ringBuffer, region * kRegionBytes);
    fences[region] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void writeUniformsAndTexels(int frame) {
    glFinish();
    const GLfloat tint[4] = {0.4F + float(frame) * 0.1F, 0.9F, 1.0F - float(frame) * 0.15F, 1};
    std::memcpy(uniforms, tint, sizeof tint);
    Sequence numbers(unsigned(frame) + 12);
    for (int i = 0; i < 64; ++i) {
        texels[i] = numbers.byte();
    }
}

void drawTexelQuad() {
    const GLfloat quad[] = {-0.9F, -0.9F, 0.9F, -0.9F, 0.9F, -0.3F, -0.9F, -0.9F, 0.9F, -0.3F, -0.9F, -0.3F};
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof quad, quad, GL_STATIC_DRAW);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glUniform1i(1, 1);
    glDrawArrays(GL_TRIANGLES, 0, 6);
    glUniform1i(1, 0);
    glDeleteBuffers(1, &buffer);
}

void setUp() {
    program =
        buildProgram({{GL_VERTEX_SHADER, "#version 430\nlayout(location=0) in vec2 place; out vec2 where;\n"
                                         "void main() { where = place; gl_Position = vec4(place, 0, 1); }\n"},
                      {GL_FRAGMENT_SHADER, "#version 430\nin vec2 where; layout(location=1) uniform int fromTexels;\n"
                                           "layout(binding=2) uniform samplerBuffer texels; out vec4 result;\n"
                                           "layout(std140, binding=1) uniform Block { vec4 tint; };\n"
                                           "void main() { result = tint * (0.6 + 0.4 * where.x);\n"
                                           "if (fromTexels != 0) { ivec2 cell = ivec2((where + vec2(0.9)) * 8.0);\n"
                                           "result = texelFetch(texels, (cell.y * 4 + cell.x) % 16); } }\n"}});
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glEnableVertexAttribArray(0);
    GLuint names[5];
    glGenBuffers(5, names);
    coherentBuffer = names[0], flushedBuffer = names[1], ringBuffer = names[2];
    uniformBuffer = names[3], texelBuffer = names[4];
    coherent = mapPersistently(coherentBuffer, kRegionBytes, GL_MAP_COHERENT_BIT);
    flushed = mapPersistently(flushedBuffer, kRegionBytes, GL_MAP_FLUSH_EXPLICIT_BIT);
    ring = mapPersistently(ringBuffer, kRegionBytes * kRegions, GL_MAP_COHERENT_BIT);
    uniforms = mapPersistently(uniformBuffer, 256, GL_MAP_COHERENT_BIT);
    texels = reinterpret_cast<GLubyte*>(mapPersistently(texelBuffer, 64, GL_MAP_COHERENT_BIT));
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniformBuffer);
    glGenTextures(1, &texelTexture);
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_BUFFER, texelTexture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA8, texelBuffer);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 4};
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.12F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            glUseProgram(program);
            writeUniformsAndTexels(frame);
            drawCoherent(frame);
            drawFlushed(frame);
            drawRing(frame);
            drawTexelQuad();
        });
}
