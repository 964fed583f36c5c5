// Bindless images: stores from fragment shaders whose result other pixels read, atomics, a level, a layer, and a
// buffer. The handles come from uniforms and from memory. There are no compute shaders
// (docs/measurements/exactness.md).
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/needs.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kSize = 32;
GLuint canvas, layers, counts, cells, cellBuffer, handleBuffer, vertexArray;
GLuint64 canvasImage, layerImage, countImage, cellImage, canvasTexture, layerTexture, countTexture, cellTexture;
GLuint scatter, tally, fill, show, showCounts;

const char* const kVertex =
    "#version 430\nuniform vec4 box; out vec2 corner; void main() {\n"
    "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1 & 1); gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n";

void makeTally() {
    tally = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, R"(#version 430
#extension GL_ARB_bindless_texture : require
layout(r32ui, bindless_image) uniform uimage2D counts; in vec2 corner; out vec4 result;
void main() { imageAtomicAdd(counts, ivec2(int(corner.x * 3.99), 0), 1u); result = vec4(0.2, corner, 1); })"}});
}

void makePrograms() {
    // Each fragment writes to another place of the picture, which other nodes' regions need.
    scatter = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, R"(#version 430
#extension GL_ARB_bindless_texture : require
layout(std430, binding=0) readonly buffer Handles { uvec2 handles[4]; };
in vec2 corner; uniform int frame; out vec4 result;
void main() { ivec2 p = ivec2(31.99 * corner); ivec2 to = ivec2(31 - p.y, (p.x + frame * 3) & 31);
imageStore(image2D(handles[0]), to, vec4(corner, float(frame) * 0.2, 1)); result = vec4(corner.yx * 0.5, 0.3, 1); })"}});
    fill = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, R"(#version 430
#extension GL_ARB_bindless_texture : require
uniform int frame; in vec2 corner; out vec4 result;
layout(rgba8, bindless_image) writeonly uniform image2D layer; layout(rgba32f, bindless_image) writeonly uniform imageBuffer cells;
void main() { ivec2 p = ivec2(31.99 * corner); uint v = uint(p.x * 29 ^ p.y * (53 + frame));
vec4 c = vec4(float(v & 255u), float(v >> 3 & 255u), float(p.y * 8), 255) / 255.0; imageStore(layer, p, c); imageStore(cells, p.y * 32 + p.x, c.bgra); result = c; })"}});
    show = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, R"(#version 430
#extension GL_ARB_bindless_texture : require
in vec2 corner; layout(bindless_sampler) uniform sampler2D image; layout(bindless_sampler) uniform sampler2DArray images;
layout(bindless_sampler) uniform samplerBuffer cells; uniform int which; out vec4 result;
void main() { ivec2 p = ivec2(31.99 * corner);
result = which == 0 ? texelFetch(image, p, 0) : which == 1 ? texelFetch(images, ivec3(p, 1), 0) : texelFetch(cells, p.y * 32 + p.x); result.a = 1.0; })"}});
    showCounts = buildProgram({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, R"(#version 430
#extension GL_ARB_bindless_texture : require
in vec2 corner; layout(bindless_sampler) uniform usampler2D counts; out vec4 result;
void main() { uint n = texelFetch(counts, ivec2(corner.x * 4.0, 0), 0).r; result = vec4(float(n & 255u), float(n >> 8 & 255u), float(n >> 16), 255) / 255.0; })"}});
}

GLuint makeTexture(GLenum target, GLenum format, int width, int height, int depth) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(target, texture);
    if (depth > 1) {
        glTexStorage3D(target, 1, format, width, height, depth);
    } else {
        glTexStorage2D(target, 1, format, width, height);
    }
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindTexture(target, 0);
    return texture;
}

GLuint64 residentTexture(GLuint texture) {
    const GLuint64 handle = glGetTextureHandleARB(texture);
    glMakeTextureHandleResidentARB(handle);
    return handle;
}

void setUp(Window&) {
    needExtension("GL_ARB_bindless_texture");
    makePrograms();
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    canvas = makeTexture(GL_TEXTURE_2D, GL_RGBA8, kSize, kSize, 1);
    layers = makeTexture(GL_TEXTURE_2D_ARRAY, GL_RGBA8, kSize, kSize, 3);
    counts = makeTexture(GL_TEXTURE_2D, GL_R32UI, 4, 1, 1);
    GLuint buffers[2];
    glGenBuffers(2, buffers);
    cellBuffer = buffers[0], handleBuffer = buffers[1];
    glBindBuffer(GL_TEXTURE_BUFFER, cellBuffer);
    glBufferData(GL_TEXTURE_BUFFER, kSize * kSize * 16, nullptr, GL_DYNAMIC_COPY);
    glGenTextures(1, &cells);
    glBindTexture(GL_TEXTURE_BUFFER, cells);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, cellBuffer);
    canvasTexture = residentTexture(canvas), layerTexture = residentTexture(layers);
    countTexture = residentTexture(counts), cellTexture = residentTexture(cells);
    canvasImage = glGetImageHandleARB(canvas, 0, GL_FALSE, 0, GL_RGBA8);
    layerImage = glGetImageHandleARB(layers, 0, GL_FALSE, 1, GL_RGBA8);
    countImage = glGetImageHandleARB(counts, 0, GL_FALSE, 0, GL_R32UI);
    cellImage = glGetImageHandleARB(cells, 0, GL_FALSE, 0, GL_RGBA32F);
    glMakeImageHandleResidentARB(layerImage, GL_WRITE_ONLY);
    glMakeImageHandleResidentARB(cellImage, GL_WRITE_ONLY);
    glMakeImageHandleResidentARB(countImage, GL_READ_WRITE);
    const GLuint64 handles[4] = {canvasImage, 0, 0, 0};
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, handleBuffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof handles, handles, GL_STATIC_DRAW);
}

void box(GLuint program, float x, float y, float width, float height) {
    glUniform4f(glGetUniformLocation(program, "box"), x, y, width, height);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void drawFrame(Window&, int frame) {
    glClearColor(0.1F, 0.1F, 0.15F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const GLuint zero = 0;
    glClearTexImage(counts, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    glUseProgram(fill);
    glUniform1i(glGetUniformLocation(fill, "frame"), frame);
    glUniformHandleui64ARB(glGetUniformLocation(fill, "layer"), layerImage);
    glUniformHandleui64ARB(glGetUniformLocation(fill, "cells"), cellImage);
    box(fill, -0.95F, 0.5F, 0.4F, 0.45F);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glMakeImageHandleResidentARB(canvasImage, GL_READ_WRITE);
    glUseProgram(scatter);
    glUniform1i(glGetUniformLocation(scatter, "frame"), frame);
    box(scatter, -0.95F, -0.95F, 0.9F, 1.4F);
    if (frame > 0) { // before this, only memory reveals that a shader writes
        if (tally == 0) {
            makeTally();
        }
        glUseProgram(tally);
        glUniformHandleui64ARB(glGetUniformLocation(tally, "counts"), countImage);
        box(tally, -0.5F, 0.5F, 0.45F, 0.4F);
    }
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    showBits(0, GLuint(glIsImageHandleResidentARB(canvasImage)));
    glMakeImageHandleNonResidentARB(canvasImage);
    showBits(1, GLuint(glIsImageHandleResidentARB(canvasImage)));
    glUseProgram(show);
    glUniformHandleui64ARB(glGetUniformLocation(show, "image"), canvasTexture);
    glUniformHandleui64ARB(glGetUniformLocation(show, "images"), layerTexture);
    glUniformHandleui64ARB(glGetUniformLocation(show, "cells"), cellTexture);
    for (int which = 0; which < 3; ++which) {
        glUniform1i(glGetUniformLocation(show, "which"), which);
        box(show, which == 1 ? 0.5F : 0.02F, which == 2 ? 0.1F : -0.9F, 0.45F, 0.9F);
    }
    glUseProgram(showCounts);
    glUniformHandleui64ARB(glGetUniformLocation(showCounts, "counts"), countTexture);
    box(showCounts, 0.5F, 0.1F, 0.45F, 0.6F);
    GLfloat cell[4] = {};
    glBindBuffer(GL_TEXTURE_BUFFER, cellBuffer);
    glGetBufferSubData(GL_TEXTURE_BUFFER, 16 * (kSize + 5), sizeof cell, cell);
    showBits(2, cell[0]);
}

} // namespace

int main(int argc, char** argv) { return runInGlxWindow(argc, argv, {Profile::Core, 4, 5}, setUp, drawFrame); }
