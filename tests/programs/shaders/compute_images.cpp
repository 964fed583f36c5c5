// Compute shaders: shared memory, indirect dispatch, images of several formats with loads, stores and counters, and
// results used as textures, vertices and draw commands.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kSize = 64;
GLuint vertexArray, paint, blur, particles, commandsProgram, show, draw, fragmentImages;
GLuint pictures[3], counts, particleBuffer, commandBuffer, dispatchBuffer;

void makePrograms() {
    paint = buildProgram({{GL_COMPUTE_SHADER, R"(#version 430
layout(local_size_x=8, local_size_y=8) in; layout(rgba8, binding=0) writeonly uniform image2D target; uniform int frame;
void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); uint v = uint(p.x * 37 ^ p.y * (91 + frame * 2));
imageStore(target, p, vec4(float(v & 255u), float((v >> 2) & 255u), float(p.x * 4), 255) / 255.0); })"}});
    blur = buildProgram({{GL_COMPUTE_SHADER, R"(#version 430
layout(local_size_x=64) in; layout(rgba8, binding=0) readonly uniform image2D source;
layout(r32f, binding=1) writeonly uniform image2D target; layout(r32ui, binding=2) uniform uimage2D tally;
shared float row[64];
void main() { int y = int(gl_WorkGroupID.x); int x = int(gl_LocalInvocationIndex);
vec4 c = imageLoad(source, ivec2(x, y)); row[x] = dot(c.rgb, vec3(0.25, 0.5, 0.25)); barrier(); memoryBarrierShared();
float sum = row[max(x - 2, 0)] + row[max(x - 1, 0)] + row[x] + row[min(x + 1, 63)] + row[min(x + 2, 63)];
imageStore(target, ivec2(x, y), vec4(sum * 0.2)); imageAtomicAdd(tally, ivec2(int(c.r * 15.99), 0), 1u); })"}});
    particles = buildProgram({{GL_COMPUTE_SHADER, R"(#version 430
layout(local_size_x=32) in; struct Particle { vec2 place; vec2 speed; };
layout(std430, binding=0) buffer All { Particle all[]; };
void main() { uint i = gl_GlobalInvocationID.x; if (i >= uint(all.length())) return;
Particle p = all[i]; p.place += p.speed; if (abs(p.place.x) > 0.4) p.speed.x = -p.speed.x;
if (abs(p.place.y) > 0.4) p.speed.y = -p.speed.y; all[i] = p; })"}});
    commandsProgram = buildProgram({{GL_COMPUTE_SHADER, R"(#version 430
layout(local_size_x=1) in; layout(std430, binding=1) buffer Commands { uint command[4]; }; uniform uint wanted;
void main() { command[0] = wanted; command[1] = 1u; command[2] = 2u; command[3] = 0u; })"}});
    const char* const vertex =
        "#version 430\nuniform vec4 box; out vec2 corner; void main() {\n"
        "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1); gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n";
    show =
        buildProgram({{GL_VERTEX_SHADER, vertex},
                      {GL_FRAGMENT_SHADER, "#version 430\nin vec2 corner; uniform sampler2D image; out vec4 result;\n"
                                           "void main() { result = vec4(texture(image, corner).rgb, 1); }\n"}});
    draw = buildProgram(
        {{GL_VERTEX_SHADER, "#version 430\nlayout(location=0) in vec4 particle; uniform vec2 offset; out vec2 speed;\n"
                            "void main() { speed = particle.zw * 40.0; gl_PointSize = 5.0;\n"
                            "gl_Position = vec4(particle.xy + offset, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER,
          "#version 430\nin vec2 speed; out vec4 result; void main() { result = vec4(abs(speed), 0.8, 1); }\n"}});
    fragmentImages = buildProgram({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, R"(#version 430
in vec2 corner; layout(rgba8, binding=3) uniform image2D canvas; out vec4 result;
void main() { ivec2 p = ivec2(corner * 64.0); vec4 old = imageLoad(canvas, p); result = vec4(old.gbr, 1); })"}});
}

void makeObjects() {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glGenTextures(3, pictures);
    const GLenum formats[] = {GL_RGBA8, GL_R32F, GL_RGBA8};
    for (int i = 0; i < 3; ++i) {
        glBindTexture(GL_TEXTURE_2D, pictures[i]);
        glTexStorage2D(GL_TEXTURE_2D, 1, formats[i], kSize, kSize);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    glGenTextures(1, &counts);
    glBindTexture(GL_TEXTURE_2D, counts);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32UI, 16, 1);
    GLfloat start[96 * 4];
    Sequence numbers(5);
    for (int i = 0; i < 96 * 4; ++i) {
        start[i] = (numbers.unit() - 0.5F) * (i % 4 < 2 ? 0.8F : 0.05F);
    }
    GLuint buffers[3];
    glGenBuffers(3, buffers);
    particleBuffer = buffers[0], commandBuffer = buffers[1], dispatchBuffer = buffers[2];
    glBindBuffer(GL_ARRAY_BUFFER, particleBuffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof start, start, GL_DYNAMIC_COPY);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commandBuffer);
    glBufferData(GL_DRAW_INDIRECT_BUFFER, 16, nullptr, GL_DYNAMIC_COPY);
    const GLuint groups[] = {0, 0, 0, 3, 1, 1};
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, dispatchBuffer);
    glBufferData(GL_DISPATCH_INDIRECT_BUFFER, sizeof groups, groups, GL_STATIC_DRAW);
}

void compute(int frame) {
    glBindImageTexture(0, pictures[0], 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    glUseProgram(paint);
    glUniform1i(glGetUniformLocation(paint, "frame"), frame);
    glDispatchCompute(8, 8, 1);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    const GLuint zero = 0;
    glClearTexImage(counts, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    glBindImageTexture(0, pictures[0], 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA8);
    glBindImageTexture(1, pictures[1], 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
    glBindImageTexture(2, counts, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
    glUseProgram(blur);
    glDispatchCompute(kSize, 1, 1);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, particleBuffer);
    glUseProgram(particles);
    for (int i = 0; i < 3; ++i) {
        glDispatchComputeIndirect(12);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, commandBuffer);
    glUseProgram(commandsProgram);
    glUniform1ui(glGetUniformLocation(commandsProgram, "wanted"), 40U + GLuint(frame) * 10U);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void showPicture(GLuint program, GLuint texture, float x, float y) {
    glUseProgram(program);
    glBindTexture(GL_TEXTURE_2D, texture);
    glUniform4f(glGetUniformLocation(program, "box"), x, y, 0.6F, 0.9F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// Shader writes are also visible in a mapping by name.
void showMapped(int row) {
    const auto* whole = static_cast<const GLuint*>(glMapNamedBuffer(commandBuffer, GL_READ_ONLY));
    const GLuint count = whole ? whole[0] : ~0U;
    glUnmapNamedBuffer(commandBuffer);
    const auto* part = static_cast<const GLuint*>(glMapNamedBufferRange(commandBuffer, 4, 8, GL_MAP_READ_BIT));
    const GLuint instances = part ? part[0] : ~0U;
    glUnmapNamedBuffer(commandBuffer);
    showBits(row, count);
    showBits(row + 1, instances);
}

void drawResults() {
    glDisableVertexAttribArray(0);
    showPicture(show, pictures[0], -0.95F, -0.95F);
    showPicture(show, pictures[1], -0.3F, -0.95F);
    glBindImageTexture(3, pictures[0], 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA8);
    showPicture(fragmentImages, pictures[2], 0.35F, -0.95F);
    glUseProgram(draw);
    glUniform2f(glGetUniformLocation(draw, "offset"), 0, 0.45F);
    glBindBuffer(GL_ARRAY_BUFFER, particleBuffer);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glDrawArraysIndirect(GL_POINTS, nullptr);
    glDisable(GL_PROGRAM_POINT_SIZE);
    GLuint tally[16] = {};
    glBindTexture(GL_TEXTURE_2D, counts);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, tally);
    for (int i = 0; i < 8; ++i) {
        showBits(28 + i, tally[i]);
    }
    showMapped(36);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 4};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            makePrograms();
            makeObjects();
        },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.1F, 0.12F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            compute(frame);
            drawResults();
        });
}
