// A window and a framebuffer object without depth buffers, with strips and fans that are rectangles. Mesa's software
// driver has another rasteriser for those, which not all of its paths use.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

GLuint vertexArray, plain, textured, framebuffer, texture;

const char* const kVertex = "#version 130\nuniform vec4 box; out vec2 corner; void main() {\n"
                            "vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1); corner = c;\n"
                            "gl_Position = vec4(box.xy + c * box.zw, 0, 1); }\n";

void setUp() {
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    plain = buildProgram({{GL_VERTEX_SHADER, kVertex},
                          {GL_FRAGMENT_SHADER, "#version 130\nuniform vec3 color; out vec4 result;\n"
                                               "void main() { result = vec4(color, 1); }\n"}});
    textured =
        buildProgram({{GL_VERTEX_SHADER, kVertex},
                      {GL_FRAGMENT_SHADER, "#version 130\nuniform sampler2D image; in vec2 corner; out vec4 result;\n"
                                           "void main() { result = texture(image, corner); }\n"}});
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 61, 45, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void box(GLuint program, float x, float y, float w, float h) {
    glUniform4f(glGetUniformLocation(program, "box"), x, y, w, h);
}

// Sends the drawing so far to the rasteriser, so that later drawing is another scene.
void endScene() {
    GLubyte pixel[4];
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
}

void drawPlain(int frame) {
    Sequence numbers(11U + unsigned(frame));
    glUseProgram(plain);
    for (int i = 0; i < 24; ++i) {
        glUniform3f(glGetUniformLocation(plain, "color"), numbers.unit(), i % 2 == 0 ? 1.0F : 0.0F, numbers.unit());
        box(plain, numbers.unit() * 1.6F - 0.9F, numbers.unit() * 1.6F - 0.9F, 0.05F + 0.3F * numbers.unit(),
            0.05F + 0.3F * numbers.unit());
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        if (i % 3 == 0) {
            endScene();
        }
    }
}

void drawTextured(int frame) {
    glUseProgram(textured);
    for (int i = 0; i < 12; ++i) {
        box(textured, -1.0F + 0.16F * float(i), -0.95F + 0.04F * float(frame), 0.13F + 0.01F * float(i), 0.9F);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        if (i % 4 == 0) {
            endScene();
        }
    }
}

void draw(Window& window, int frame) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, 61, 45);
    glClearColor(0.2F, 0.3F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    drawPlain(frame);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.1F, 0.3F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    drawPlain(frame);
    drawTextured(frame);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.depth = 0;
    spec.stencil = 0;
    return runInGlxWindow(
        argc, argv, spec, [](Window&) { setUp(); }, draw);
}
