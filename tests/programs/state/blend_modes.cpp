// Blending: all factors and equations, separate, constant colour, two sources, per draw buffer, with alpha in the
// window, minimum and maximum, indexed colour masks, sRGB framebuffers.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint vertexArray, plain, dual, several, show;
GLuint targets[2], framebuffer;
int cellIndex;

const char* const kVertex = "#version 400\nuniform vec4 box; out vec2 corner; void main() {\n"
                            "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                            "gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n";

void setUp() {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    plain = buildProgram(
        {{GL_VERTEX_SHADER, kVertex},
         {GL_FRAGMENT_SHADER, "#version 400\nin vec2 corner; uniform vec4 tint; out vec4 result;\n"
                              "void main() { result = vec4(corner, 1.0 - corner.x, corner.y) * tint; }\n"}});
    dual = buildProgram(
        {{GL_VERTEX_SHADER, kVertex},
         {GL_FRAGMENT_SHADER,
          "#version 400\nin vec2 corner; uniform vec4 tint; layout(location=0, index=0) out vec4 first;\n"
          "layout(location=0, index=1) out vec4 second; void main() { first = vec4(corner, 0.5, 0.8) * tint;\n"
          "second = vec4(1.0 - corner.y, corner.x, 0.3, corner.x); }\n"}});
    several = buildProgram(
        {{GL_VERTEX_SHADER, kVertex},
         {GL_FRAGMENT_SHADER, "#version 400\nin vec2 corner; uniform vec4 tint; layout(location=0) out vec4 a;\n"
                              "layout(location=1) out vec4 b; void main() { a = vec4(corner, 0, 0.5) * tint;\n"
                              "b = vec4(0.5, corner.yx, 0.5); }\n"}});
    show =
        buildProgram({{GL_VERTEX_SHADER, kVertex},
                      {GL_FRAGMENT_SHADER, "#version 400\nin vec2 corner; uniform sampler2D image; out vec4 result;\n"
                                           "void main() { result = texture(image, corner); }\n"}});
    glGenTextures(2, targets);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    for (int i = 0; i < 2; ++i) {
        glBindTexture(GL_TEXTURE_2D, targets[i]);
        glTexStorage2D(GL_TEXTURE_2D, 1, i == 0 ? GL_SRGB8_ALPHA8 : GL_RGBA8, 32, 32);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + GLenum(i), GL_TEXTURE_2D, targets[i], 0);
    }
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void box(GLuint program, float x, float y, float w, float h, Color tint) {
    glUseProgram(program);
    glUniform4f(glGetUniformLocation(program, "box"), x, y, w, h);
    glUniform4f(glGetUniformLocation(program, "tint"), tint.red, tint.green, tint.blue, tint.alpha);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// Draws a backdrop without blending, and a shape with the caller's blending over it.
void cell(GLuint program, int frame) {
    const float x = -0.98F + 0.165F * float(cellIndex % 12);
    const float y = -0.98F + 0.3F * float(cellIndex / 12);
    ++cellIndex;
    glDisable(GL_BLEND);
    box(plain, x, y, 0.15F, 0.2F, {0.8F, 0.6F, 0.9F, 0.7F});
    glEnable(GL_BLEND);
    box(program, x, y + 0.08F, 0.15F, 0.18F, {1, 0.9F, 0.2F * float(frame), 0.75F});
    glDisable(GL_BLEND);
}

void drawFactors(int frame) {
    const GLenum factors[] = {GL_ZERO,
                              GL_ONE,
                              GL_SRC_COLOR,
                              GL_ONE_MINUS_SRC_COLOR,
                              GL_DST_COLOR,
                              GL_ONE_MINUS_DST_COLOR,
                              GL_SRC_ALPHA,
                              GL_ONE_MINUS_SRC_ALPHA,
                              GL_DST_ALPHA,
                              GL_ONE_MINUS_DST_ALPHA,
                              GL_CONSTANT_COLOR,
                              GL_ONE_MINUS_CONSTANT_COLOR,
                              GL_CONSTANT_ALPHA,
                              GL_ONE_MINUS_CONSTANT_ALPHA,
                              GL_SRC_ALPHA_SATURATE};
    glBlendColor(0.3F, 0.6F, 0.1F * float(frame), 0.4F);
    for (int i = 0; i < 15; ++i) {
        glBlendFunc(factors[i], GL_ONE_MINUS_SRC_ALPHA);
        cell(plain, frame);
        glBlendFuncSeparate(GL_ONE, i == 14 ? GL_ZERO : factors[i], factors[(i + 3) % 14], GL_ONE);
        cell(plain, frame);
    }
}

void drawEquations(int frame) {
    glBlendFunc(GL_SRC_ALPHA, GL_ONE);
    for (const GLenum equation : {GL_FUNC_ADD, GL_FUNC_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT, GL_MIN, GL_MAX}) {
        glBlendEquation(equation);
        cell(plain, frame);
        glBlendEquationSeparate(GL_FUNC_ADD, equation);
        cell(plain, frame);
    }
    glBlendEquation(GL_FUNC_ADD);
    for (const GLenum factor : {GL_SRC1_COLOR, GL_ONE_MINUS_SRC1_COLOR, GL_SRC1_ALPHA, GL_ONE_MINUS_SRC1_ALPHA}) {
        glBlendFunc(GL_ONE, factor);
        cell(dual, frame);
    }
}

void drawIndexed(Window& window, int frame) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, 32, 32);
    glClearColor(0.2F, 0.4F, 0.6F, 0.5F);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnablei(GL_BLEND, 1);
    glBlendFunci(0, GL_ONE, GL_ONE);
    glBlendFuncSeparatei(1, GL_SRC_ALPHA, GL_ONE, GL_ONE, GL_ZERO);
    glBlendEquationi(1, GL_FUNC_REVERSE_SUBTRACT);
    glColorMaski(0, GL_TRUE, frame % 2 == 0 ? GL_TRUE : GL_FALSE, GL_TRUE, GL_TRUE);
    if (frame % 2 == 1) {
        glEnable(GL_FRAMEBUFFER_SRGB);
    }
    box(several, -0.9F, -0.8F, 1.5F, 1.4F, {1, 0.7F, 0.4F, 1});
    box(several, -0.4F, -0.3F, 1.2F, 1.2F, {0.6F, 0.9F, 0.4F, 1});
    glDisable(GL_FRAMEBUFFER_SRGB);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ZERO);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window.width(), window.height());
    for (int i = 0; i < 2; ++i) {
        glBindTexture(GL_TEXTURE_2D, targets[i]);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        box(show, -0.95F + 0.5F * float(i), 0.5F, 0.45F, 0.45F, {1, 1, 1, 1});
    }
}

// Shows the window's alpha as brightness.
void showAlpha(Window& window) {
    GLubyte alpha[16] = {};
    glReadPixels(window.width() / 24, window.height() / 12, 4, 4, GL_ALPHA, GL_UNSIGNED_BYTE, alpha);
    for (int i = 0; i < 16; ++i) {
        const float level = float(alpha[i]) / 255.0F;
        fillRectangle(window.width() / 2 + i * 5, window.height() - 8, 4, 6, {level, level, level});
    }
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec = {Profile::Compatibility, 4, 3};
    spec.alpha = 8;
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window& window, int frame) {
            glClearColor(0.2F, 0.2F, 0.2F, 0.6F);
            glClear(GL_COLOR_BUFFER_BIT);
            cellIndex = 0;
            drawFactors(frame);
            drawEquations(frame);
            drawIndexed(window, frame);
            showAlpha(window);
        });
}
