// Textures of OpenGL 3 and 4: arrays, immutable storage, views, samplers, buffer textures, multisample
// textures, integer, float, packed and compressed formats, swizzles, clears, copies between images.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <string>
#include <vector>

using namespace programs;

namespace {

GLuint vertexArray;
GLuint names[24];
int cellIndex;

// A program per sampler type, which samples at `at` (2D coordinates and a layer or depth).
struct SamplerProgram {
    const char* sampler;
    const char* expression;
    GLuint program;
};

SamplerProgram samplers[] = {
    {"sampler2D", "texture(image, at.xy)", 0},
    {"sampler2DArray", "texture(image, at)", 0},
    {"sampler1DArray", "texture(image, at.xz)", 0},
    {"samplerCubeArray", "texture(image, vec4(at.x - 0.5, at.y - 0.5, 0.5, at.z))", 0},
    {"samplerBuffer", "texelFetch(image, int(at.x * 8.0) + 8 * int(at.y * 4.0))", 0},
    {"sampler2DMS", "texelFetch(image, ivec2(at.xy * 16.0), int(at.z))", 0},
    {"usampler2D", "vec4(texture(image, at.xy)) / 255.0", 0},
    {"isampler2D", "vec4(abs(texture(image, at.xy))) / 127.0", 0},
    {"sampler2DShadow", "vec4(texture(image, vec3(at.xy, at.z)))", 0},
    {"sampler3D", "texture(image, at)", 0},
    {"sampler2D", "textureGather(image, at.xy, 1)", 0},
    {"sampler2D", "textureLod(image, at.xy, at.z)", 0},
};
enum Kind { Plain, Array, Array1D, CubeArray, Buffer, Multisample, Unsigned, Signed, Shadow, Volume, Gather, Lod };

std::vector<GLubyte> noise(std::size_t count, unsigned seed) {
    std::vector<GLubyte> bytes(count);
    Sequence numbers(seed);
    for (GLubyte& value : bytes) {
        value = numbers.byte();
    }
    return bytes;
}

void makePrograms() {
    for (SamplerProgram& entry : samplers) {
        const std::string fragment =
            std::string("#version 430\nin vec2 corner; layout(location=1) uniform float layer;\n") + "uniform " +
            entry.sampler + " image; out vec4 result;\n" +
            "void main() { vec3 at = vec3(corner, layer); result = vec4((" + entry.expression + ").rgb, 1); }\n";
        entry.program =
            buildProgram({{GL_VERTEX_SHADER, "#version 430\nlayout(location=0) uniform vec2 offset; out vec2 corner;\n"
                                             "void main() { corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                             "gl_Position = vec4(offset + corner * vec2(0.28, 0.3), 0, 1); }\n"},
                          {GL_FRAGMENT_SHADER, fragment.c_str()}});
    }
}

void drawCell(Kind kind, float layer = 0) {
    glUseProgram(samplers[kind].program);
    glUniform2f(0, -0.97F + 0.32F * float(cellIndex % 6), -0.97F + 0.33F * float(cellIndex / 6));
    glUniform1f(1, layer);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    ++cellIndex;
}

void nearest(GLenum target) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void drawArrays(unsigned frame) {
    glBindTexture(GL_TEXTURE_2D_ARRAY, names[0]);
    nearest(GL_TEXTURE_2D_ARRAY);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, 8, 8, 5, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 noise(1280, 1 + frame).data());
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 2, 2, 3, 4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE, noise(64, 2).data());
    drawCell(Array, float(frame % 5));
    drawCell(Array, 3);
    glBindTexture(GL_TEXTURE_1D_ARRAY, names[1]);
    nearest(GL_TEXTURE_1D_ARRAY);
    glTexImage2D(GL_TEXTURE_1D_ARRAY, 0, GL_RGBA8, 8, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, noise(128, 3 + frame).data());
    drawCell(Array1D, 2);
    glBindTexture(GL_TEXTURE_CUBE_MAP_ARRAY, names[2]);
    nearest(GL_TEXTURE_CUBE_MAP_ARRAY);
    glTexImage3D(GL_TEXTURE_CUBE_MAP_ARRAY, 0, GL_RGBA8, 4, 4, 12, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 noise(768, 4 + frame).data());
    drawCell(CubeArray, float(frame % 2));
    glBindTexture(GL_TEXTURE_3D, names[3]);
    glTexStorage3D(GL_TEXTURE_3D, 1, GL_RGBA8, 4, 4, 4);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, 4, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, noise(256, 5 + frame).data());
    glGenerateMipmap(GL_TEXTURE_3D);
    drawCell(Volume, 0.4F);
}

// Draws immutable storage through views of another format, level and layer.
void drawStorageAndViews(unsigned frame) {
    glBindTexture(GL_TEXTURE_2D, names[4]);
    glTexStorage2D(GL_TEXTURE_2D, 4, GL_RGBA8, 16, 16);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 16, 16, GL_RGBA, GL_UNSIGNED_BYTE, noise(1024, 6 + frame).data());
    glGenerateMipmap(GL_TEXTURE_2D);
    drawCell(Lod, float(frame % 4));
    glTextureView(names[5], GL_TEXTURE_2D, names[4], GL_RGBA8UI, 1, 2, 0, 1);
    glBindTexture(GL_TEXTURE_2D, names[5]);
    nearest(GL_TEXTURE_2D);
    drawCell(Unsigned);
    glTextureView(names[6], GL_TEXTURE_2D_ARRAY, names[4], GL_RGBA8, 0, 1, 0, 1);
    glBindTexture(GL_TEXTURE_2D_ARRAY, names[6]);
    nearest(GL_TEXTURE_2D_ARRAY);
    drawCell(Array, 0);
    // Clears and copies without framebuffers.
    const GLubyte color[4] = {GLubyte(frame * 60), 200, 90, 255};
    glClearTexSubImage(names[4], 0, 2, 2, 0, 5, 9, 1, GL_RGBA, GL_UNSIGNED_BYTE, color);
    glCopyImageSubData(names[0], GL_TEXTURE_2D_ARRAY, 0, 0, 0, 3, names[4], GL_TEXTURE_2D, 0, 8, 8, 0, 8, 8, 1);
    glBindTexture(GL_TEXTURE_2D, names[4]);
    drawCell(Plain);
    drawCell(Gather);
}

void drawSamplers(unsigned frame) {
    GLuint sampler = 0;
    glGenSamplers(1, &sampler);
    const GLfloat border[4] = {1, 0.5F, float(frame) * 0.2F, 1};
    glSamplerParameterfv(sampler, GL_TEXTURE_BORDER_COLOR, border);
    glSamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glSamplerParameteri(sampler, GL_TEXTURE_WRAP_T, GL_MIRRORED_REPEAT);
    glSamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameterf(sampler, GL_TEXTURE_MIN_LOD, 1);
    glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glBindTexture(GL_TEXTURE_2D, names[4]);
    glBindSampler(0, sampler);
    drawCell(Plain);
    glBindSampler(0, 0);
    glDeleteSamplers(1, &sampler);
    const GLint swizzle[4] = {GL_BLUE, GL_ONE, frame % 2 == 0 ? GL_RED : GL_ZERO, GL_ALPHA};
    glTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, swizzle);
    drawCell(Plain);
}

void drawBufferTexture(unsigned frame) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBufferData(GL_TEXTURE_BUFFER, 512, noise(512, 8 + frame).data(), GL_STREAM_DRAW);
    glBindTexture(GL_TEXTURE_BUFFER, names[7]);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA8, buffer);
    drawCell(Buffer);
    glBufferSubData(GL_TEXTURE_BUFFER, 256, 64, noise(64, 9).data());
    glTexBufferRange(GL_TEXTURE_BUFFER, GL_RGBA8, buffer, 256, 128);
    drawCell(Buffer);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA8, 0);
    glDeleteBuffers(1, &buffer);
}

void drawFormats(unsigned frame) {
    struct Format {
        GLint internal;
        GLenum format, type;
        Kind kind;
    };
    const Format formats[] = {{GL_R8, GL_RED, GL_UNSIGNED_BYTE, Plain},
                              {GL_RG16, GL_RG, GL_UNSIGNED_SHORT, Plain},
                              {GL_RGB9_E5, GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV, Plain},
                              {GL_R11F_G11F_B10F, GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV, Plain},
                              {GL_RGB10_A2, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, Plain},
                              {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, Plain},
                              {GL_RGBA8_SNORM, GL_RGBA, GL_BYTE, Plain},
                              {GL_RGBA8UI, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, Unsigned},
                              {GL_RGBA16I, GL_RGBA_INTEGER, GL_BYTE, Signed}};
    int index = 8;
    for (const Format& format : formats) {
        glBindTexture(GL_TEXTURE_2D, names[index]);
        nearest(GL_TEXTURE_2D);
        glTexImage2D(GL_TEXTURE_2D, 0, format.internal, 6, 6, 0, format.format, format.type,
                     noise(6 * 6 * 8, unsigned(index) + frame).data());
        drawCell(format.kind);
        ++index;
    }
    GLfloat depths[36];
    for (int i = 0; i < 36; ++i) {
        depths[i] = float((i * 7) % 36) / 36.0F;
    }
    glBindTexture(GL_TEXTURE_2D, names[17]);
    nearest(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, 6, 6, 0, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
    drawCell(Shadow, 0.2F * float(frame % 5));
}

void drawCompressed(unsigned frame) {
    const GLenum formats[] = {GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, GL_COMPRESSED_RG_RGTC2,
                              GL_COMPRESSED_RGBA_BPTC_UNORM};
    const GLsizei blockBytes[] = {8, 16, 16, 16};
    for (int i = 0; i < 4; ++i) {
        const auto data = noise(std::size_t(blockBytes[i]) * 4, 60 + unsigned(i) + frame);
        glBindTexture(GL_TEXTURE_2D, names[18 + i]);
        nearest(GL_TEXTURE_2D);
        glCompressedTexImage2D(GL_TEXTURE_2D, 0, formats[i], 8, 8, 0, blockBytes[i] * 4, data.data());
        glCompressedTexSubImage2D(GL_TEXTURE_2D, 0, 4, 4, 4, 4, formats[i], blockBytes[i], data.data());
        drawCell(Plain);
    }
    // A texture that GL has compressed: its blocks are read and uploaded again.
    GLubyte blocks[128];
    glBindTexture(GL_TEXTURE_2D, names[22]);
    nearest(GL_TEXTURE_2D);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_COMPRESSED_RG_RGTC2, 8, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 noise(256, 70 + frame).data());
    glGetCompressedTexImage(GL_TEXTURE_2D, 0, blocks);
    glCompressedTexImage2D(GL_TEXTURE_2D, 0, GL_COMPRESSED_RG_RGTC2, 8, 8, 0, 64, blocks);
    drawCell(Plain);
}

void drawMultisample(unsigned frame) {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, names[23]);
    glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGBA8, 16, 16, GL_TRUE);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, names[23], 0);
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    glViewport(0, 0, 16, 16);
    glClearColor(0.2F, 0.2F * float(frame), 0.6F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glBindTexture(GL_TEXTURE_2D, names[4]);
    const int saved = cellIndex;
    cellIndex = 6;
    drawCell(Plain);
    cellIndex = 20;
    drawCell(Plain);
    cellIndex = saved;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    drawCell(Multisample, 0);
    drawCell(Multisample, 2);
    glDeleteFramebuffers(1, &framebuffer);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 5};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            makePrograms();
            glGenVertexArrays(1, &vertexArray);
            glBindVertexArray(vertexArray);
        },
        [](Window&, int frame) {
            glGenTextures(24, names);
            glClearColor(0.1F, 0.15F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            cellIndex = 0;
            const auto number = unsigned(frame);
            drawArrays(number);
            drawStorageAndViews(number);
            drawSamplers(number);
            drawBufferTexture(number);
            drawFormats(number);
            drawCompressed(number);
            drawMultisample(number);
            glDeleteTextures(24, names);
        });
}
