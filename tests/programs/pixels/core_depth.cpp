// Depth and stencil in a core context, read from the window and from a framebuffer object. They are also copied from
// the window into a texture, with a copy and with a blit. The results are drawn as colours.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

GLuint vertexArray, program, framebuffer, copied, target;

void drawScene(int frame) {
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_STENCIL_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    glUseProgram(program);
    for (int i = 0; i < 5; ++i) {
        glStencilFunc(GL_ALWAYS, 10 * i + frame, 0xff);
        glUniform4f(0, -0.9F + 0.25F * float(i), -0.8F + 0.1F * float(frame), 0.7F, 1.3F);
        glUniform1f(1, 0.1F * float(i) - 0.3F);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_STENCIL_TEST);
}

// Returns a sum that reveals one wrong value anywhere.
template <class T> std::uint32_t digest(const std::vector<T>& values) {
    std::uint32_t sum = 17;
    for (const T value : values) {
        sum = sum * 31 + std::uint32_t(value);
    }
    return sum;
}

void showRead(int row, int width, int height) {
    const auto count = std::size_t(width) * std::size_t(height);
    std::vector<GLuint> depth(count);
    std::vector<GLuint> both(count);
    std::vector<GLubyte> stencil(count);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, depth.data());
    glReadPixels(0, 0, width, height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencil.data());
    glReadPixels(0, 0, width, height, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, both.data());
    const GLint drawn = [] {
        GLint name = 0;
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &name);
        return name;
    }();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    showBits(row, digest(depth));
    showBits(row - 1, digest(stencil));
    showBits(row - 2, digest(both));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(drawn));
}

GLuint makeTexture(GLint width, GLint height) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH24_STENCIL8, width, height, 0, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    return name;
}

void setUp(Window& window) {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    program = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 430\nlayout(location=0) uniform vec4 box; layout(location=1) uniform float depth; out vec3 tint;\n"
          "void main() { vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1); tint = vec3(c, depth);\n"
          "gl_Position = vec4(box.xy + c * box.zw, depth + 0.3 * c.x * c.y, 1); }\n"},
         {GL_FRAGMENT_SHADER,
          "#version 430\nin vec3 tint; out vec4 result; void main() { result = vec4(tint, 1); }\n"}});
    copied = makeTexture(window.width(), window.height());
    target = makeTexture(window.width(), window.height());
    glGenFramebuffers(1, &framebuffer);
}

void readBack(GLuint texture, int row, const Window& window) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    glReadBuffer(GL_NONE);
    showRead(row, window.width(), window.height());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 3};
    return runInGlxWindow(
        argc, argv, spec, [](Window& window) { setUp(window); },
        [](Window& window, int frame) {
            glClearColor(0.1F, 0.12F, 0.1F, 1);
            glClearDepth(0.9);
            glClearStencil(3);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
            drawScene(frame);
            showRead(37, window.width(), window.height());
            // From the window with a copy.
            glBindTexture(GL_TEXTURE_2D, copied);
            glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, window.width(), window.height());
            readBack(copied, 33, window);
            // From the window with a blit.
            glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
            glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, target, 0);
            glDrawBuffer(GL_NONE);
            glBlitFramebuffer(0, 0, window.width(), window.height(), 0, 0, window.width(), window.height(),
                              GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, GL_NEAREST);
            glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
            readBack(target, 29, window);
        });
}
