// Errors of drawing commands in OpenGL ES 3.1, where indirect draws need buffers and a vertex array.
#include <GLES3/gl31.h>

#include "tests/programs/draw_errors/buffers.hpp"
#include "tests/programs/draw_errors/record.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <functional>
#include <vector>

using namespace programs;

namespace {

DrawBuffers buffers;
GLuint emptyFramebuffer, plainProgram, computeProgram;

const void* at(std::uintptr_t offset) { return reinterpret_cast<const void*>(offset); }

std::vector<std::function<void()>> calls() {
    std::vector<std::function<void()>> all;
    for (const GLenum mode : {GL_TRIANGLES, GL_LINES, 7, 99}) {
        for (const GLsizei count : {3, 0, -1}) {
            all.push_back([=] { glDrawArrays(mode, 0, count); });
            all.push_back([=] { glDrawArrays(mode, -1, count); });
            all.push_back([=] { glDrawArraysInstanced(mode, 0, count, 1); });
            all.push_back([=] { glDrawElements(mode, count, GL_UNSIGNED_SHORT, nullptr); });
            all.push_back([=] { glDrawElements(mode, count, GL_FLOAT, nullptr); });
            all.push_back([=] { glDrawElementsInstanced(mode, count, GL_UNSIGNED_SHORT, nullptr, 1); });
            all.push_back([=] { glDrawRangeElements(mode, 3, 0, count, GL_UNSIGNED_SHORT, nullptr); });
        }
        for (const std::uintptr_t offset : {0U, 2U, 252U, 4096U}) {
            all.push_back([=] { glDrawArraysIndirect(mode, at(offset)); });
            all.push_back([=] { glDrawElementsIndirect(mode, GL_UNSIGNED_SHORT, at(offset)); });
        }
        all.push_back([=] { glDrawElementsIndirect(mode, GL_FLOAT, nullptr); });
    }
    for (const GLbitfield mask : {GL_COLOR_BUFFER_BIT, 0x80}) {
        all.push_back([=] { glClear(mask); });
        all.push_back([=] { glBlitFramebuffer(0, 0, 4, 4, 8, 8, 12, 12, mask, GL_NEAREST); });
    }
    for (const GLint drawBuffer : {0, 1, 99}) {
        const GLfloat color[4] = {0.5F, 0.2F, 0.3F, 1};
        all.push_back([=] { glClearBufferfv(GL_COLOR, drawBuffer, color); });
        all.push_back([=] { glClearBufferfv(GL_DEPTH, drawBuffer, color); });
        all.push_back([=] { glClearBufferfv(GL_STENCIL, drawBuffer, color); });
        all.push_back([=] { glClearBufferfi(GL_DEPTH_STENCIL, drawBuffer, 1, 0); });
    }
    for (const GLintptr offset : {0, 2, -4, 4096}) {
        all.push_back([=] { glDispatchComputeIndirect(offset); });
    }
    all.push_back([] { glDispatchCompute(1, 1, 1); });
    all.push_back([] { glDispatchCompute(1, 100000000, 1); });
    return all;
}

struct Situation {
    std::function<void()> begin, end;
};

std::vector<Situation> situations() {
    return {
        {[] {}, [] {}},
        {[] { glBindFramebuffer(GL_FRAMEBUFFER, emptyFramebuffer); }, [] { glBindFramebuffer(GL_FRAMEBUFFER, 0); }},
        {[] { glUseProgram(computeProgram); }, [] { glUseProgram(plainProgram); }},
        {[] { glUseProgram(0); }, [] { glUseProgram(plainProgram); }},
        {[] { glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0); },
         [] { glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffers.indirect); }},
        {[] { glMapBufferRange(GL_DRAW_INDIRECT_BUFFER, 0, 4, GL_MAP_WRITE_BIT); },
         [] { glUnmapBuffer(GL_DRAW_INDIRECT_BUFFER); }},
        {[] { glMapBufferRange(GL_ARRAY_BUFFER, 0, 4, GL_MAP_WRITE_BIT); }, [] { glUnmapBuffer(GL_ARRAY_BUFFER); }},
    };
}

void makeObjects() {
    buffers = makeDrawBuffers();
    glGenFramebuffers(1, &emptyFramebuffer);
    plainProgram = buildProgram(
        {{GL_VERTEX_SHADER, "#version 310 es\nin vec4 p; void main() { gl_Position = p * 0.1; }"},
         {GL_FRAGMENT_SHADER, "#version 310 es\nprecision highp float; out vec4 o; void main() { o = vec4(0.5); }"}});
    computeProgram =
        buildProgram({{GL_COMPUTE_SHADER, "#version 310 es\nlayout(local_size_x = 1) in; void main() {}"}});
    glUseProgram(plainProgram);
}

void drawFrame() {
    std::vector<std::uint32_t> sums;
    for (const Situation& situation : situations()) {
        situation.begin();
        std::uint32_t sum = 0;
        for (const auto& call : calls()) {
            call();
            sum = foldErrors(sum, glGetError);
        }
        situation.end();
        sums.push_back(foldErrors(sum, glGetError));
    }
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        showBits(int(i), sums[i]);
    }
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.profile = Profile::Es;
    spec.major = 3;
    spec.minor = 1;
    return runInEglWindow(
        argc, argv, spec, [](Window&) { makeObjects(); }, [](Window&, int) { drawFrame(); });
}
