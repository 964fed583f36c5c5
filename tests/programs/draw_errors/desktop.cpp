// Errors of drawing commands, from their arguments or from the state: an incomplete framebuffer, mapped buffers,
// unsuitable programs. MURAL_CORE: in a core context. Each row of the picture shows the errors of one group of calls in
// one situation.
#include "tests/programs/support/gl.hpp"

#include "tests/programs/draw_errors/buffers.hpp"
#include "tests/programs/draw_errors/record.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <functional>
#include <vector>

using namespace programs;

namespace {

#ifdef MURAL_CORE
constexpr bool kCore = true;
#else
constexpr bool kCore = false;
#endif

using Calls = std::vector<std::function<void()>>;

constexpr GLenum kModes[] = {GL_TRIANGLES, GL_LINES, GL_PATCHES, GL_QUADS, 99};
const GLfloat kFloats[4] = {0.1F, 0.2F, 0.3F, 1};
const GLint kInts[4] = {};
const GLuint kUints[4] = {};

const void* at(std::uintptr_t offset) { return reinterpret_cast<const void*>(offset); }

Calls arrayDraws() {
    Calls calls;
    for (const GLenum mode : kModes) {
        for (const GLsizei count : {3, 0, -1}) {
            calls.push_back([=] { glDrawArrays(mode, 0, count); });
            calls.push_back([=] { glDrawArrays(mode, -1, count); });
            calls.push_back([=] { glDrawArraysInstanced(mode, 0, count, 2); });
            calls.push_back([=] { glDrawArraysInstanced(mode, 0, 3, count); });
            calls.push_back([=] { glDrawArraysInstancedBaseInstance(mode, 0, count, 1, 1); });
            calls.push_back([=] {
                const GLint firsts[2] = {0, 0};
                const GLsizei counts[2] = {3, count};
                glMultiDrawArrays(mode, firsts, counts, 2);
            });
        }
        calls.push_back([=] { glMultiDrawArrays(mode, nullptr, nullptr, -1); });
        calls.push_back([=] { glDrawTransformFeedback(mode, 999); });
        calls.push_back([=] { glDrawTransformFeedbackInstanced(mode, 0, -1); });
        calls.push_back([=] { glDrawTransformFeedbackStream(mode, 0, 77); });
    }
    return calls;
}

Calls elementDraws() {
    Calls calls;
    for (const GLenum mode : kModes) {
        for (const GLenum type : {GL_UNSIGNED_SHORT, GL_FLOAT}) {
            for (const GLsizei count : {3, -1}) {
                calls.push_back([=] { glDrawElements(mode, count, type, nullptr); });
                calls.push_back([=] { glDrawElementsBaseVertex(mode, count, type, nullptr, 1); });
                calls.push_back([=] { glDrawElementsInstanced(mode, count, type, nullptr, 2); });
                calls.push_back([=] { glDrawElementsInstanced(mode, 3, type, nullptr, count); });
                calls.push_back(
                    [=] { glDrawElementsInstancedBaseVertexBaseInstance(mode, count, type, nullptr, 1, 1, 1); });
                calls.push_back([=] { glDrawRangeElements(mode, 0, 3, count, type, nullptr); });
                calls.push_back([=] { glDrawRangeElements(mode, 3, 0, count, type, nullptr); });
                calls.push_back([=] {
                    const GLsizei counts[2] = {3, count};
                    const void* indices[2] = {nullptr, nullptr};
                    glMultiDrawElements(mode, counts, type, indices, 2);
                });
            }
        }
    }
    return calls;
}

Calls indirectDraws() {
    Calls calls;
    for (const GLenum mode : kModes) {
        for (const std::uintptr_t offset : {0U, 2U, 252U}) {
            calls.push_back([=] { glDrawArraysIndirect(mode, at(offset)); });
            calls.push_back([=] { glDrawElementsIndirect(mode, GL_UNSIGNED_SHORT, at(offset)); });
            calls.push_back([=] { glMultiDrawArraysIndirect(mode, at(offset), 2, 0); });
            calls.push_back([=] { glMultiDrawElementsIndirect(mode, GL_UNSIGNED_SHORT, at(offset), 2, 3); });
        }
        calls.push_back([=] { glDrawElementsIndirect(mode, GL_FLOAT, nullptr); });
        calls.push_back([=] { glMultiDrawArraysIndirect(mode, nullptr, -1, 0); });
    }
    for (const GLuint groups : {1U, 0U, 100000000U}) {
        calls.push_back([=] { glDispatchCompute(groups, 1, 1); });
    }
    for (const GLintptr offset : {0, 2, -4, 252, 1 << 20}) {
        calls.push_back([=] { glDispatchComputeIndirect(offset); });
    }
    return calls;
}

Calls clears() {
    Calls calls;
    for (const GLbitfield mask :
         {GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_STENCIL_BUFFER_BIT, GL_ACCUM_BUFFER_BIT, 0x80, 0}) {
        calls.push_back([=] { glClear(mask); });
    }
    for (const GLint drawBuffer : {0, 1, 7, 8, 99, -1}) {
        for (const GLenum buffer : {GL_COLOR, GL_DEPTH, GL_STENCIL, GL_DEPTH_STENCIL, GL_RGBA}) {
            calls.push_back([=] { glClearBufferfv(buffer, drawBuffer, kFloats); });
            calls.push_back([=] { glClearBufferiv(buffer, drawBuffer, kInts); });
            calls.push_back([=] { glClearBufferuiv(buffer, drawBuffer, kUints); });
            calls.push_back([=] { glClearBufferfi(buffer, drawBuffer, 1, 0); });
            for (const GLuint framebuffer : {0U, 777U}) {
                calls.push_back([=] { glClearNamedFramebufferfv(framebuffer, buffer, drawBuffer, kFloats); });
                calls.push_back([=] { glClearNamedFramebufferfi(framebuffer, buffer, drawBuffer, 1, 0); });
            }
        }
    }
    return calls;
}

Calls blits() {
    Calls calls;
    for (const GLbitfield mask : {GL_COLOR_BUFFER_BIT, GL_DEPTH_BUFFER_BIT, 0x80}) {
        for (const GLenum filter : {GL_NEAREST, GL_LINEAR, GL_REPEAT}) {
            calls.push_back([=] { glBlitFramebuffer(0, 0, 8, 8, 0, 0, 8, 8, mask, filter); });
            calls.push_back([=] { glBlitFramebuffer(0, 0, 8, 8, 0, 0, 4, 4, mask, filter); });
            calls.push_back([=] { glBlitNamedFramebuffer(777, 0, 0, 0, 8, 8, 0, 0, 8, 8, mask, filter); });
        }
    }
    calls.push_back([] { glMemoryBarrier(GL_ALL_BARRIER_BITS); });
    calls.push_back([] { glMemoryBarrier(0x40000000); });
    return calls;
}

const GLubyte kPixels[64] = {};

Calls oldPixels() {
    Calls calls;
    for (const GLsizei size : {2, 0, -1}) {
        calls.push_back([=] { glDrawPixels(size, 2, GL_RGBA, GL_UNSIGNED_BYTE, kPixels); });
        calls.push_back([=] { glDrawPixels(size, 2, GL_RGBA, GL_BITMAP, kPixels); });
        calls.push_back([=] { glDrawPixels(size, 2, GL_RG8, GL_UNSIGNED_BYTE, kPixels); });
        calls.push_back([=] { glDrawPixels(size, 2, GL_RGBA_INTEGER, GL_INT, kPixels); });
        calls.push_back([=] { glDrawPixels(size, 2, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, kPixels); });
        calls.push_back([=] { glDrawPixels(size, 2, GL_DEPTH_COMPONENT, GL_FLOAT, kPixels); });
        calls.push_back([=] { glBitmap(size, 2, 0, 0, 0, 0, kPixels); });
        for (const GLenum type : {GL_COLOR, GL_DEPTH, GL_STENCIL, GL_RGBA}) {
            calls.push_back([=] { glCopyPixels(0, 0, size, 2, type); });
        }
    }
    for (const GLenum op : {GL_ACCUM, GL_RETURN, GL_RGBA}) {
        calls.push_back([=] { glAccum(op, 1); });
    }
    return calls;
}

// Makes calls between glBegin and glEnd, where only few commands are permitted.
void inside(GLenum mode, const std::function<void()>& calls) {
    glBegin(mode);
    glVertex2f(0, 0);
    calls();
    glColor3f(1, 0, 0);
    glVertex2f(1, 0);
    glVertex2f(0, 1);
    glEnd();
}

GLuint list, plainProgram;

Calls primitives() {
    Calls calls;
    for (const GLenum mode : kModes) {
        calls.push_back([=] { inside(mode, [] {}); });
        calls.push_back([=] { inside(mode, [] { glEnable(GL_BLEND); }); });
        calls.push_back([=] { inside(mode, [] { glUseProgram(plainProgram); }); });
        calls.push_back([=] { inside(mode, [] { glBegin(GL_LINES); }); });
        calls.push_back([=] { inside(mode, [] { glRectf(0, 0, 1, 1); }); });
        calls.push_back([=] { inside(mode, [] { glDrawArrays(GL_LINES, 0, 2); }); });
        calls.push_back([=] { inside(mode, [] { glClear(GL_COLOR_BUFFER_BIT); }); });
        calls.push_back([=] { inside(mode, [] { glBindTexture(GL_TEXTURE_2D, 0); }); });
        calls.push_back([=] { inside(mode, [] { glMatrixMode(GL_MODELVIEW); }); });
        calls.push_back([=] { inside(mode, [] { glCallList(list); }); });
        calls.push_back([=] { inside(mode, [] { glArrayElement(0); }); });
        calls.push_back([=] { glEvalMesh1(mode, 0, 2); });
    }
    calls.push_back([] { glEvalMesh2(GL_FILL, 0, 1, 0, 1); });
    calls.push_back([] { glRectf(-1, -1, -0.5F, -0.5F); });
    calls.push_back([] { glEnd(); });
    return calls;
}

struct Situation {
    std::function<void()> begin, end;
};

DrawBuffers buffers;
GLuint feedback, emptyFramebuffer, integerFramebuffer, multisampledFramebuffer, conflictProgram, feedbackProgram,
    geometryProgram, tessellationProgram, computeProgram;

void makeBuffers() {
    buffers = makeDrawBuffers();
    glGenBuffers(1, &feedback);
    glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, feedback);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
}

void makeFramebuffers() {
    GLuint textures[2];
    glGenTextures(2, textures);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8I, 16, 16, 0, GL_RGBA_INTEGER, GL_BYTE, nullptr);
    glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, textures[1]);
    glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGBA8, 16, 16, GL_TRUE);
    glGenFramebuffers(1, &emptyFramebuffer);
    glGenFramebuffers(1, &integerFramebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, integerFramebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[0], 0);
    glGenFramebuffers(1, &multisampledFramebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, multisampledFramebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE, textures[1], 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void makePrograms() {
    const Stage vertex = {GL_VERTEX_SHADER, "#version 150\nin vec4 p; void main() { gl_Position = p * 0.1; }"};
    const Stage fragment = {GL_FRAGMENT_SHADER, "#version 150\nout vec4 o; void main() { o = vec4(0.5); }"};
    plainProgram = buildProgram({vertex, fragment});
    conflictProgram =
        buildProgram({vertex,
                      {GL_FRAGMENT_SHADER, "#version 150\nuniform sampler2D a; uniform sampler3D b; out vec4 o;"
                                           "void main() { o = texture(a, vec2(0)) + texture(b, vec3(0)); }"}});
    feedbackProgram = buildProgram({vertex, fragment}, [](unsigned program) {
        const char* varying = "gl_Position";
        glTransformFeedbackVaryings(program, 1, &varying, GL_INTERLEAVED_ATTRIBS);
    });
    geometryProgram =
        buildProgram({vertex,
                      fragment,
                      {GL_GEOMETRY_SHADER, "#version 150\nlayout(lines) in; layout(points, max_vertices = 1) out;"
                                           "void main() { gl_Position = gl_in[0].gl_Position; EmitVertex(); }"}});
    tessellationProgram =
        buildProgram({vertex,
                      fragment,
                      {GL_TESS_EVALUATION_SHADER,
                       "#version 400\nlayout(triangles) in; void main() { gl_Position = gl_in[0].gl_Position; }"}});
    computeProgram = buildProgram({{GL_COMPUTE_SHADER, "#version 430\nlayout(local_size_x = 1) in; void main() {}"}});
}

Situation withProgram(GLuint program) {
    return {[=] { glUseProgram(program); }, [] { glUseProgram(plainProgram); }};
}

Situation withMapped(GLenum target) {
    return {[=] { glMapBuffer(target, GL_WRITE_ONLY); }, [=] { glUnmapBuffer(target); }};
}

Situation withFramebuffer(GLenum target, GLuint framebuffer) {
    return {[=] { glBindFramebuffer(target, framebuffer); }, [] { glBindFramebuffer(GL_FRAMEBUFFER, 0); }};
}

std::vector<Situation> situations() {
    std::vector<Situation> all = {
        {[] {}, [] {}},
        withFramebuffer(GL_FRAMEBUFFER, emptyFramebuffer),
        withProgram(conflictProgram),
        withMapped(GL_ARRAY_BUFFER),
        withMapped(GL_ELEMENT_ARRAY_BUFFER),
        withMapped(GL_DRAW_INDIRECT_BUFFER),
        withFramebuffer(GL_DRAW_FRAMEBUFFER, integerFramebuffer),
        withFramebuffer(GL_READ_FRAMEBUFFER, integerFramebuffer),
        withFramebuffer(GL_READ_FRAMEBUFFER, multisampledFramebuffer),
        {[] {
             glUseProgram(feedbackProgram);
             glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedback);
             glBeginTransformFeedback(GL_TRIANGLES);
         },
         [] {
             glEndTransformFeedback();
             glUseProgram(plainProgram);
         }},
        withProgram(geometryProgram),
        withProgram(tessellationProgram),
        withProgram(computeProgram),
        withProgram(0),
        {[] { glBindVertexArray(0); }, [] { glBindVertexArray(buffers.vertexArray); }},
    };
    if (!kCore) {
        all.pop_back(); // client arrays would have invalid addresses
        all.push_back({[] { glEnable(GL_VERTEX_PROGRAM_ARB); }, [] { glDisable(GL_VERTEX_PROGRAM_ARB); }});
        all.push_back({[] { glRasterPos2f(9, 9); }, [] {}});
    } else {
        all.push_back({[] { glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0); },
                       [] { glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffers.indirect); }});
    }
    return all;
}

std::vector<Calls> groups() {
    std::vector<Calls> all = {arrayDraws(), elementDraws(), indirectDraws(), clears(), blits()};
    if (!kCore) {
        all.push_back(oldPixels());
        all.push_back(primitives());
    }
    return all;
}

void drawFrame(int frame) {
    constexpr int kPerFrame = 4;
    const auto all = situations();
    std::vector<std::uint32_t> sums;
    glUseProgram(plainProgram);
    for (int i = 0; i < kPerFrame; ++i) {
        const Situation& situation = all[std::size_t(frame * kPerFrame + i) % all.size()];
        situation.begin();
        for (const Calls& calls : groups()) {
            std::uint32_t sum = 0;
            for (const auto& call : calls) {
                call();
                sum = foldErrors(sum, glGetError);
            }
            sums.push_back(sum);
        }
        situation.end();
        sums.push_back(foldErrors(0, glGetError));
    }
    glDisable(GL_BLEND);
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        showBits(int(i), sums[i]);
    }
    glGetError();
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    if (kCore) {
        spec.profile = Profile::Core;
        spec.major = 4;
        spec.minor = 5;
    }
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            makeBuffers();
            makeFramebuffers();
            makePrograms();
            if (!kCore) {
                glNewList(list = glGenLists(1), GL_COMPILE);
                glColor3f(0, 1, 0);
                glVertex2f(0.5F, 0.5F);
                glEndList();
            }
        },
        [](Window&, int frame) { drawFrame(frame); });
}
