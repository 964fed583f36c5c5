// OpenGL 4.5 without binding: buffers, vertex arrays, textures, framebuffers, samplers, pipelines and queries created
// and used by name; multi-bind; EXT_direct_state_access matrices and uniforms.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>
#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 32;
GLuint program, vertexArray, buffers[3], textures[4], framebuffers[2], renderbuffer, samplers[2], query;

void makeBuffers() {
    glCreateBuffers(3, buffers);
    const GLfloat corners[] = {0, 0, 1, 0, 0, 1, 1, 1};
    glNamedBufferStorage(buffers[0], sizeof corners, corners, 0);
    const GLushort order[] = {0, 1, 2, 2, 1, 3};
    glNamedBufferData(buffers[1], sizeof order, order, GL_STATIC_DRAW);
    glNamedBufferData(buffers[2], 256, nullptr, GL_DYNAMIC_DRAW);
    glCreateVertexArrays(1, &vertexArray);
    glVertexArrayVertexBuffer(vertexArray, 1, buffers[0], 0, 8);
    glVertexArrayVertexBuffer(vertexArray, 2, buffers[2], 0, 4);
    glVertexArrayAttribFormat(vertexArray, 0, 2, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribFormat(vertexArray, 1, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0);
    glVertexArrayAttribBinding(vertexArray, 0, 1);
    glVertexArrayAttribBinding(vertexArray, 1, 2);
    glVertexArrayBindingDivisor(vertexArray, 2, 1);
    glEnableVertexArrayAttrib(vertexArray, 0);
    glEnableVertexArrayAttrib(vertexArray, 1);
    glVertexArrayElementBuffer(vertexArray, buffers[1]);
}

void makeTextures() {
    glCreateTextures(GL_TEXTURE_2D, 3, textures);
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, textures + 3);
    for (int i = 0; i < 3; ++i) {
        glTextureStorage2D(textures[i], 3, GL_RGBA8, kSize, kSize);
        glTextureParameteri(textures[i], GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    }
    glTextureStorage3D(textures[3], 1, GL_RGBA8, 8, 8, 3);
    glCreateSamplers(2, samplers);
    glSamplerParameteri(samplers[0], GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glSamplerParameteri(samplers[0], GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glSamplerParameteri(samplers[1], GL_TEXTURE_WRAP_S, GL_MIRROR_CLAMP_TO_EDGE);
    glSamplerParameteri(samplers[1], GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glCreateFramebuffers(2, framebuffers);
    glNamedFramebufferTexture(framebuffers[0], GL_COLOR_ATTACHMENT0, textures[1], 0);
    glCreateRenderbuffers(1, &renderbuffer);
    glNamedRenderbufferStorage(renderbuffer, GL_RGBA8, kSize, kSize);
    glNamedFramebufferRenderbuffer(framebuffers[1], GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
    for (const GLuint framebuffer : framebuffers) {
        if (glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
            fail("a framebuffer is incomplete");
        }
    }
}

void update(int frame) {
    GLubyte texels[kSize * kSize * 4];
    Sequence numbers(unsigned(frame) + 80);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glTextureSubImage2D(textures[0], 0, 0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    glGenerateTextureMipmap(textures[0]);
    glTextureSubImage3D(textures[3], 0, 0, 0, 1, 8, 8, 2, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    auto* colors = static_cast<GLubyte*>(
        glMapNamedBufferRange(buffers[2], 0, 256, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT));
    std::memcpy(colors, texels + 64, 256);
    glUnmapNamedBuffer(buffers[2]);
    const GLuint white = 0xffffffffU;
    glClearNamedBufferSubData(buffers[2], GL_R32UI, 8, 4, GL_RED_INTEGER, GL_UNSIGNED_INT, &white);
    glCopyNamedBufferSubData(buffers[2], buffers[2], 16, 64, 16);
    glNamedBufferSubData(buffers[2], 12, 4, texels);
}

void render(int frame) {
    const GLfloat clear[] = {0.1F * float(frame), 0.3F, 0.5F, 1};
    glClearNamedFramebufferfv(framebuffers[0], GL_COLOR, 0, clear);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[0]);
    glViewport(0, 0, kSize, kSize);
    glUniform4f(0, -0.8F, -0.8F, 1.2F, 1.2F);
    glUniform1i(1, 0);
    glDrawElementsInstanced(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, nullptr, 2);
    glBlitNamedFramebuffer(framebuffers[0], framebuffers[1], 0, 0, kSize, kSize, kSize, 0, 0, kSize,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glNamedFramebufferReadBuffer(framebuffers[1], GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers[1]);
    glCopyTextureSubImage2D(textures[2], 0, 4, 4, 8, 8, 24, 24);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void drawWindow(Window& window, int frame) {
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.15F, 0.15F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glBindTextures(0, 3, textures);
    const GLuint both[] = {samplers[0], samplers[1], 0};
    glBindSamplers(0, 3, both);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    for (int i = 0; i < 3; ++i) {
        glUniform4f(0, -0.95F + 0.65F * float(i), -0.9F, 0.5F, 0.8F);
        glUniform1i(1, i);
        glDrawElementsInstanced(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, nullptr, 4 + frame);
    }
    glEndQuery(GL_SAMPLES_PASSED);
    glBlitNamedFramebuffer(framebuffers[1], 0, 0, 0, kSize, kSize, 10, window.height() - 60, 90, window.height() - 10,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
    // Copies from the window by its name, while an object is bound for reading.
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers[0]);
    glBlitNamedFramebuffer(0, framebuffers[1], 0, 0, window.width(), window.height(), 0, 0, kSize, kSize,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers[1]);
    std::vector<GLubyte> small(std::size_t(kSize) * kSize * 4);
    glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, small.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    std::uint32_t sum = 0;
    for (const GLubyte value : small) {
        sum = sum * 31 + value;
    }
    showBits(3, sum);
    GLuint passed = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &passed);
    showBits(0, passed);
    GLubyte texels[8 * 8 * 4] = {};
    glGetTextureSubImage(textures[3], 0, 0, 0, 1, 8, 8, 1, GL_RGBA, GL_UNSIGNED_BYTE, sizeof texels, texels);
    GLuint word = 0;
    std::memcpy(&word, texels + 40, sizeof word);
    showBits(1, word);
    GLuint stored = 0;
    glGetNamedBufferSubData(buffers[2], 68, 4, &stored);
    showBits(2, stored);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 5};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            program = buildProgram(
                {{GL_VERTEX_SHADER,
                  "#version 450\nlayout(location=0) in vec2 corner; layout(location=1) in vec4 color;\n"
                  "layout(location=0) uniform vec4 box; out vec2 at; flat out vec4 tint; void main() { at = corner; "
                  "tint = color;\n"
                  "gl_Position = vec4(box.xy + corner * box.zw * (1.0 - 0.2 * float(gl_InstanceID)), 0, 1); }\n"},
                 {GL_FRAGMENT_SHADER, "#version 450\nin vec2 at; flat in vec4 tint; layout(location=1) uniform int "
                                      "which; out vec4 result;\n"
                                      "layout(binding=0) uniform sampler2D images[3]; void main() { vec4 t = which == "
                                      "0 ? texture(images[0], at)\n"
                                      ": which == 1 ? texture(images[1], at * 1.5) : texture(images[2], at); result = "
                                      "vec4(t.rgb * 0.7 + tint.rgb * 0.3, 1); }\n"}});
            makeBuffers();
            makeTextures();
            glCreateQueries(GL_SAMPLES_PASSED, 1, &query);
            glBindVertexArray(vertexArray);
            const GLubyte blank[4] = {40, 80, 120, 255};
            for (const GLuint texture : {textures[0], textures[1], textures[2], textures[3]}) {
                glClearTexImage(texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, blank);
            }
            glGenerateTextureMipmap(textures[1]);
            glGenerateTextureMipmap(textures[2]);
        },
        [](Window& window, int frame) {
            glUseProgram(program);
            update(frame);
            glBindTextures(0, 3, nullptr);
            glBindTextureUnit(0, textures[0]);
            glBindTextureUnit(1, textures[2]);
            glBindTextureUnit(2, textures[2]);
            render(frame);
            drawWindow(window, frame);
        });
}
