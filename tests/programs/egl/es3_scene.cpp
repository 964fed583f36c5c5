// OpenGL ES 3.1 through EGL: vertex arrays, uniform blocks, instances, several targets, integer and 3D textures,
// transform feedback, mapped buffers, fences, compute.
#include <GLES3/gl31.h>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>
#include <vector>

using namespace programs;

namespace {

GLuint vertexArray, blocks, targetsProgram, show, showVolume, feedbackProgram, compute;
GLuint uniformBuffer, instanceBuffer, feedbackBuffer, feedback, targets[2], framebuffer, volume, image, queryName;

const char* const kQuad =
    "#version 310 es\nuniform vec4 box; out vec2 corner; void main() {\n"
    "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1); gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n";

void makePrograms() {
    blocks = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 310 es\nlayout(location=0) in vec4 instance; layout(std140, binding=2) uniform Block { vec4 tint; "
          "vec2 scale; };\n"
          "flat out vec4 color; void main() { vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
          "color = tint * vec4(instance.zw, 0.5, 1); gl_Position = vec4(instance.xy + c * scale, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER, "#version 310 es\nprecision highp float; flat in vec4 color; out vec4 result; void "
                              "main() { result = color; }\n"}});
    targetsProgram = buildProgram(
        {{GL_VERTEX_SHADER, kQuad},
         {GL_FRAGMENT_SHADER,
          "#version 310 es\nprecision highp float; in vec2 corner; layout(location=0) out vec4 a; layout(location=1) "
          "out vec4 b;\n"
          "void main() { a = vec4(corner, 0.2, 1); b = vec4(0.9, fract(corner.x * 4.0), corner.y, 1); }\n"}});
    show = buildProgram(
        {{GL_VERTEX_SHADER, kQuad},
         {GL_FRAGMENT_SHADER,
          "#version 310 es\nprecision highp float; in vec2 corner; uniform sampler2D image; out vec4 result;\n"
          "void main() { result = vec4(texture(image, corner).rgb, 1); }\n"}});
    showVolume =
        buildProgram({{GL_VERTEX_SHADER, kQuad},
                      {GL_FRAGMENT_SHADER,
                       "#version 310 es\nprecision highp float; precision highp usampler3D; in vec2 corner;\n"
                       "uniform usampler3D image; uniform float layer; out vec4 result;\n"
                       "void main() { result = vec4(vec3(texture(image, vec3(corner, layer)).rgb) / 255.0, 1); }\n"}});
    feedbackProgram = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 310 es\nlayout(location=0) in vec4 instance; uniform float turn; out vec4 moved; void main() {\n"
          "moved = instance + vec4(sin(turn + instance.y) * 0.1, 0.05, 0.1, -0.1); gl_Position = moved; gl_PointSize = "
          "1.0; }\n"},
         {GL_FRAGMENT_SHADER, "#version 310 es\nprecision highp float; out vec4 r; void main() { r = vec4(1); }\n"}},
        [](unsigned program) {
            const char* const name = "moved";
            glTransformFeedbackVaryings(program, 1, &name, GL_INTERLEAVED_ATTRIBS);
        });
    compute = buildProgram(
        {{GL_COMPUTE_SHADER, "#version 310 es\nlayout(local_size_x=8, local_size_y=8) in; uniform int frame;\n"
                             "layout(rgba8, binding=0) writeonly uniform highp image2D target; void main() {\n"
                             "ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(target, p, vec4(float((p.x * (p.y "
                             "+ frame)) & 31) / 31.0, 0.5, 0.2, 1)); }\n"}});
}

void makeObjects() {
    GLuint names[4];
    glGenBuffers(3, names);
    uniformBuffer = names[0], instanceBuffer = names[1], feedbackBuffer = names[2];
    glBindBuffer(GL_UNIFORM_BUFFER, uniformBuffer);
    glBufferData(GL_UNIFORM_BUFFER, 64, nullptr, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, 2, uniformBuffer);
    GLfloat instances[12 * 4];
    Sequence numbers(6);
    for (GLfloat& value : instances) {
        value = numbers.unit() * 1.4F - 0.8F;
    }
    glBindBuffer(GL_ARRAY_BUFFER, feedbackBuffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof instances, nullptr, GL_DYNAMIC_COPY);
    glBindBuffer(GL_ARRAY_BUFFER, instanceBuffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof instances, instances, GL_DYNAMIC_COPY);
    glGenVertexArrays(1, &vertexArray);
    glGenTransformFeedbacks(1, &feedback);
    glGenQueries(1, &queryName);
    glGenTextures(4, names);
    targets[0] = names[0], targets[1] = names[1], volume = names[2], image = names[3];
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    for (const GLuint name : {targets[0], targets[1], image}) {
        glBindTexture(GL_TEXTURE_2D, name);
        glTexStorage2D(GL_TEXTURE_2D, 1, name == targets[1] ? GL_RGB10_A2 : GL_RGBA8, 32, 32);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    for (GLuint i = 0; i < 2; ++i) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_TEXTURE_2D, targets[i], 0);
    }
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindTexture(GL_TEXTURE_3D, volume);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void drawBlocks(int frame) {
    glBindBuffer(GL_UNIFORM_BUFFER, uniformBuffer);
    auto* mapped = static_cast<GLfloat*>(
        glMapBufferRange(GL_UNIFORM_BUFFER, 0, 32, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_RANGE_BIT));
    const GLfloat values[8] = {1, 0.4F, 0.2F * float(frame), 1, 0.12F, 0.15F, 0, 0};
    std::memcpy(mapped, values, sizeof values);
    glUnmapBuffer(GL_UNIFORM_BUFFER);
    glBindVertexArray(vertexArray);
    glEnableVertexAttribArray(0);
    for (const GLuint buffer : {instanceBuffer, feedbackBuffer}) {
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 16, nullptr);
        glVertexAttribDivisor(0, 1);
        glUseProgram(blocks);
        glBeginQuery(GL_ANY_SAMPLES_PASSED, queryName);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 12);
        glEndQuery(GL_ANY_SAMPLES_PASSED);
        if (buffer == instanceBuffer) {
            // Transform feedback moves the vertices, which are drawn from there next.
            glVertexAttribDivisor(0, 0);
            glUseProgram(feedbackProgram);
            glUniform1f(glGetUniformLocation(feedbackProgram, "turn"), float(frame));
            glEnable(GL_RASTERIZER_DISCARD);
            glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, feedback);
            glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedbackBuffer);
            glBeginTransformFeedback(GL_POINTS);
            glDrawArrays(GL_POINTS, 0, 12);
            glEndTransformFeedback();
            glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
            glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
            glDisable(GL_RASTERIZER_DISCARD);
        }
    }
    glBindVertexArray(0);
    GLuint any = 0;
    glGetQueryObjectuiv(queryName, GL_QUERY_RESULT, &any);
    showBits(37, any);
}

void box(GLuint program, float x, float y) {
    glUseProgram(program);
    glUniform4f(glGetUniformLocation(program, "box"), x, y, 0.35F, 0.4F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// Draws a part of the window, read through a buffer, as a texture.
void drawRead() {
    static GLuint buffer = 0;
    static GLuint texture = 0;
    if (buffer == 0) {
        glGenBuffers(1, &buffer);
        glGenTextures(1, &texture);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    const std::vector<GLubyte> before(32 * 32 * 4, 0x60);
    glBufferData(GL_PIXEL_PACK_BUFFER, GLsizeiptr(before.size()), before.data(), GL_STREAM_READ);
    glReadPixels(-8, 20, 32, 32, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 32, 32, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    box(show, -0.55F, -0.95F);
}

void drawTextures(Window& window, int frame) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, 32, 32);
    const GLfloat clear[] = {0.3F, 0.2F, 0.1F * float(frame), 1};
    glClearBufferfv(GL_COLOR, 0, clear);
    glClearBufferfv(GL_COLOR, 1, clear);
    glUseProgram(targetsProgram);
    glUniform4f(glGetUniformLocation(targetsProgram, "box"), -0.8F, -0.7F, 1.2F + 0.1F * float(frame), 1.3F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window.width(), window.height());
    for (int i = 0; i < 2; ++i) {
        glBindTexture(GL_TEXTURE_2D, targets[i]);
        box(show, -0.95F + 0.4F * float(i), -0.95F);
    }
    glBindImageTexture(0, image, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    glUseProgram(compute);
    glUniform1i(glGetUniformLocation(compute, "frame"), frame);
    glDispatchCompute(4, 4, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    glBindTexture(GL_TEXTURE_2D, image);
    box(show, -0.15F, -0.95F);
    std::vector<GLubyte> voxels(8 * 8 * 4 * 4);
    Sequence numbers(unsigned(frame) + 11);
    for (GLubyte& value : voxels) {
        value = numbers.byte();
    }
    glBindTexture(GL_TEXTURE_3D, volume);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8UI, 8, 8, 4, 0, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, voxels.data());
    glUseProgram(showVolume);
    glUniform1f(glGetUniformLocation(showVolume, "layer"), 0.25F * float(frame % 4) + 0.1F);
    box(showVolume, 0.25F, -0.95F);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(0, 0, 32, 32, window.width() - 50, 5, window.width() - 5, 60, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    drawRead();
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 10000000000ULL);
    glDeleteSync(fence);
}

// Copies from no buffer, which is an error. The frame is shown nevertheless.
void readNothing() {
    glReadBuffer(GL_BACK);
    showBits(38, std::uint32_t{glGetError()});
    glReadBuffer(GL_NONE);
    glBindTexture(GL_TEXTURE_2D, targets[0]);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 5, 5, 16, 16);
    showBits(39, std::uint32_t{glGetError()});
}

// Samples can be resolved only at their own position.
void resolveElsewhere() {
    GLuint renderbuffer = 0;
    GLuint samples = 0;
    glGenRenderbuffers(1, &renderbuffer);
    glGenFramebuffers(1, &samples);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, samples);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, GL_RGB8, 16, 16);
    glFramebufferRenderbuffer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
    glBlitFramebuffer(0, 0, 8, 8, 100, 100, 108, 108, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    const GLenum error = glGetError();
    glDeleteFramebuffers(1, &samples);
    glDeleteRenderbuffers(1, &renderbuffer);
    showBits(40, std::uint32_t{error});
}

// Sets a divisor for a binding of array 0, which is rejected. The array keeps one value for each vertex.
void drawFromMemory() {
    static const GLfloat corners[4][4] = {
        {0.5F, 0.5F, 0.9F, 0.3F}, {0.6F, 0.45F, 0.2F, 0.8F}, {0.55F, 0.7F, 0.4F, 0.6F}, {0.8F, 0.75F, 0.7F, 0.9F}};
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, corners);
    glEnableVertexAttribArray(0);
    glVertexBindingDivisor(0, 2);
    showBits(41, std::uint32_t{glGetError()});
    glUseProgram(blocks);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisableVertexAttribArray(0);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.profile = Profile::Es;
    spec.major = 3;
    spec.minor = 1;
    return runInEglWindow(
        argc, argv, spec,
        [](Window&) {
            makePrograms();
            makeObjects();
        },
        [](Window& window, int frame) {
            glClearColor(0.1F, 0.15F, 0.15F, 1);
            glReadBuffer(GL_BACK);
            glClear(GL_COLOR_BUFFER_BIT);
            drawBlocks(frame);
            drawFromMemory();
            drawTextures(window, frame);
            resolveElsewhere();
            readNothing();
        });
}
