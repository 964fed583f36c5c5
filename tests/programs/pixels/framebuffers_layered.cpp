// A multisampled window, layered framebuffers filled by a geometry shader, cube map faces and 3D slices as targets.
// Sample masks, alpha to coverage, sample shading, blits of depth and stencil. The number of samples of a framebuffer
// without attachments, before and after drawing to it.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <string>
#include <vector>

using namespace programs;

namespace {

constexpr int kSize = 32;
GLuint layered, flat, perSample, vertexArray;
GLuint arrayTexture, cubeTexture, volumeTexture, copied, arrayFramebuffer, faceFramebuffer, stencilFramebuffer,
    emptyFramebuffer;
GLuint showLayer, showCube, showVolume;

const char* const kQuadVertex = "#version 400\nuniform vec4 box; out vec2 corner; void main() {\n"
                                "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                "gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n";
const char* const kFanVertex =
    "#version 400\nuniform float turn; uniform vec4 box; out vec3 color; void main() {\n"
    "float a = float(gl_VertexID) * 2.1 + turn; color = vec3(fract(a), fract(a * 1.7), 0.5);\n"
    "gl_Position = vec4(box.xy + vec2(cos(a), sin(a * 1.1)) * box.zw, 0, 1); }\n";

GLuint makeShow(const char* sampler, const char* lookUp) {
    const std::string source = std::string("#version 400\nin vec2 corner; uniform float layer; uniform ") + sampler +
                               " image; out vec4 result;\nvoid main() { result = vec4(" + lookUp + ".rgb, 1); }\n";
    return buildProgram({{GL_VERTEX_SHADER, kQuadVertex}, {GL_FRAGMENT_SHADER, source.c_str()}});
}

void makePrograms() {
    const char* const fragment = "#version 400\nin vec3 color; out vec4 result;\n"
                                 "void main() { result = vec4(color, color.r); }\n";
    flat = buildProgram({{GL_VERTEX_SHADER, kFanVertex}, {GL_FRAGMENT_SHADER, fragment}});
    perSample =
        buildProgram({{GL_VERTEX_SHADER, kFanVertex},
                      {GL_FRAGMENT_SHADER, "#version 400\nin vec3 color; out vec4 result; void main() {\n"
                                           "result = vec4(color * (0.4 + 0.15 * float(gl_SampleID)), 1); }\n"}});
    layered = buildProgram(
        {{GL_VERTEX_SHADER, "#version 400\nuniform float turn; uniform vec4 box; out vec3 tint; void main() {\n"
                            "float a = float(gl_VertexID) * 2.1 + turn; tint = vec3(fract(a), fract(a * 1.7), 0.5);\n"
                            "gl_Position = vec4(box.xy + vec2(cos(a), sin(a * 1.1)) * box.zw, 0, 1); }\n"},
         {GL_GEOMETRY_SHADER,
          "#version 400\nlayout(triangles) in; layout(triangle_strip, max_vertices=12) out;\n"
          "in vec3 tint[]; out vec3 color; void main() { for (int layer = 0; layer < 4; ++layer) {\n"
          "for (int i = 0; i < 3; ++i) { gl_Layer = layer; color = tint[i] * (1.0 - 0.2 * float(layer));\n"
          "gl_Position = gl_in[i].gl_Position * vec4(1.0 - 0.2 * float(layer), 1, 1, 1);\n"
          "EmitVertex(); } EndPrimitive(); } }\n"},
         {GL_FRAGMENT_SHADER, fragment}});
    showLayer = makeShow("sampler2DArray", "texture(image, vec3(corner, layer))");
    showCube = makeShow("samplerCube", "texture(image, vec3(corner - 0.5, layer))");
    showVolume = makeShow("sampler3D", "texture(image, vec3(corner, layer))");
}

void makeTarget(GLuint name, GLenum target) {
    glBindTexture(target, name);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    if (target == GL_TEXTURE_CUBE_MAP) {
        for (GLenum face = 0; face < 6; ++face) {
            glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                         nullptr);
        }
    } else {
        glTexImage3D(target, 0, GL_RGBA8, kSize, kSize, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    }
}

void setUp() {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    makePrograms();
    GLuint textures[4];
    glGenTextures(4, textures);
    arrayTexture = textures[0], cubeTexture = textures[1], volumeTexture = textures[2], copied = textures[3];
    makeTarget(arrayTexture, GL_TEXTURE_2D_ARRAY);
    makeTarget(cubeTexture, GL_TEXTURE_CUBE_MAP);
    makeTarget(volumeTexture, GL_TEXTURE_3D);
    GLuint framebuffers[4];
    glGenFramebuffers(4, framebuffers);
    arrayFramebuffer = framebuffers[0], faceFramebuffer = framebuffers[1];
    stencilFramebuffer = framebuffers[2], emptyFramebuffer = framebuffers[3];
    glBindFramebuffer(GL_FRAMEBUFFER, arrayFramebuffer);
    glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, arrayTexture, 0);
    GLuint renderbuffer = 0;
    glGenRenderbuffers(1, &renderbuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kSize, kSize);
    glBindFramebuffer(GL_FRAMEBUFFER, stencilFramebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
}

void fan(GLuint program, float turn, float x, float y, float size, GLsizei count) {
    glUseProgram(program);
    glUniform1f(glGetUniformLocation(program, "turn"), turn);
    glUniform4f(glGetUniformLocation(program, "box"), x, y, size, size);
    glDrawArrays(GL_TRIANGLES, 0, count);
}

void renderLayers(int frame) {
    glViewport(0, 0, kSize, kSize);
    glBindFramebuffer(GL_FRAMEBUFFER, arrayFramebuffer);
    glClearColor(0.1F, 0.3F, 0.3F, 1);
    glClear(GL_COLOR_BUFFER_BIT); // all layers
    fan(layered, float(frame), 0, 0, 0.9F, 9);
    glBindFramebuffer(GL_FRAMEBUFFER, faceFramebuffer);
    for (int i = 0; i < 10; ++i) {
        if (i < 6) {
            glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_CUBE_MAP_POSITIVE_X + GLenum(i),
                                   cubeTexture, 0);
        } else {
            glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, volumeTexture, 0, i - 6);
        }
        glClearColor(0.1F * float(i), 0.2F, 0.05F * float(frame), 1);
        glClear(GL_COLOR_BUFFER_BIT);
        fan(flat, float(frame + i), 0, 0, 0.8F, 6);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

std::uint32_t samplesNow() {
    GLint samples = 0;
    GLint buffers = 0;
    glGetIntegerv(GL_SAMPLES, &samples);
    glGetIntegerv(GL_SAMPLE_BUFFERS, &buffers);
    return std::uint32_t(samples) | std::uint32_t(buffers) << 4;
}

std::uint32_t drawWithoutAttachments(int frame) {
    glBindFramebuffer(GL_FRAMEBUFFER, emptyFramebuffer);
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, kSize);
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, kSize);
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_SAMPLES, 3 - frame % 4);
    const std::uint32_t before = samplesNow();
    fan(flat, float(frame), 0, 0, 0.8F, 6);
    const std::uint32_t after = samplesNow();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return before | after << 8;
}

void showTexture(GLuint program, GLenum target, GLuint texture, float layer, int cell) {
    glUseProgram(program);
    glBindTexture(target, texture);
    glUniform1f(glGetUniformLocation(program, "layer"), layer);
    glUniform4f(glGetUniformLocation(program, "box"), -0.97F + 0.33F * float(cell % 6),
                -0.97F + 0.45F * float(cell / 6), 0.3F, 0.42F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void drawMultisampledShapes(int frame) {
    fan(flat, float(frame) * 0.4F, -0.7F, 0.4F, 0.25F, 12);
    glEnable(GL_SAMPLE_MASK);
    glSampleMaski(0, 0x5U + GLuint(frame % 3));
    fan(flat, float(frame) * 0.3F, -0.2F, 0.4F, 0.25F, 12);
    glDisable(GL_SAMPLE_MASK);
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    fan(flat, float(frame) * 0.2F, 0.25F, 0.4F, 0.25F, 12);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    glEnable(GL_SAMPLE_COVERAGE);
    glSampleCoverage(0.5F, frame % 2 == 0 ? GL_TRUE : GL_FALSE);
    fan(flat, float(frame) * 0.1F, 0.7F, 0.4F, 0.25F, 9);
    glDisable(GL_SAMPLE_COVERAGE);
    glEnable(GL_SAMPLE_SHADING);
    glMinSampleShading(1);
    fan(perSample, float(frame), 0.5F, 0.8F, 0.18F, 9);
    glDisable(GL_SAMPLE_SHADING);
    glDisable(GL_MULTISAMPLE);
    fan(flat, float(frame), 0.8F, 0.8F, 0.18F, 9);
    glEnable(GL_MULTISAMPLE);
}

// Resolves the window's samples into a renderbuffer, and shows it in another corner.
void blitWindow(Window& window) {
    const int w = window.width();
    const int h = window.height();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, stencilFramebuffer);
    glBlitFramebuffer(w / 8, h * 5 / 8, w / 8 + kSize, h * 5 / 8 + kSize, 0, 0, kSize, kSize, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, stencilFramebuffer);
    GLubyte pixel[4] = {};
    glReadPixels(kSize / 2, kSize / 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    std::vector<GLubyte> read(std::size_t(kSize) * kSize * 4);
    std::uint32_t sum = 0;
    const auto add = [&] {
        for (const GLubyte value : read) {
            sum = sum * 31 + value;
        }
    };
    glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
    add();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    // Reads the window, whose samples are still present, directly and through a texture.
    glReadPixels(w / 8, h * 5 / 8, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
    add();
    glBindTexture(GL_TEXTURE_2D, copied);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, w / 8, h * 5 / 8, kSize, kSize, 0);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
    add();
    showBits(2, sum);
    showBits(0, std::uint32_t(pixel[0]) | std::uint32_t(pixel[1]) << 8 | std::uint32_t(pixel[2]) << 16);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec = {Profile::Core, 4, 0};
    spec.samples = 4;
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window& window, int frame) {
            renderLayers(frame);
            const std::uint32_t samples = drawWithoutAttachments(frame);
            glViewport(0, 0, window.width(), window.height());
            glClearColor(0.15F, 0.1F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            for (int i = 0; i < 4; ++i) {
                showTexture(showLayer, GL_TEXTURE_2D_ARRAY, arrayTexture, float(i), i);
                showTexture(showVolume, GL_TEXTURE_3D, volumeTexture, (float(i) + 0.5F) / 4, 6 + i);
            }
            showTexture(showCube, GL_TEXTURE_CUBE_MAP, cubeTexture, 0.4F, 4);
            showTexture(showCube, GL_TEXTURE_CUBE_MAP, cubeTexture, -0.2F, 5);
            drawMultisampledShapes(frame);
            blitWindow(window);
            showBits(1, samples);
        });
}
