// Program binaries: programs that were saved and loaded again draw, with their attributes, outputs, uniforms and
// transform feedback. Truncated binaries and unknown formats are rejected.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

constexpr GLuint kCorner = 3, kTint = 1;
constexpr int kSize = 32;

struct Binary {
    GLenum format = 0;
    std::vector<GLubyte> bytes;
};

GLuint vertexArray, corners, feedback, framebuffer, targets[2], pipeline, separate[2];
Binary painted, separable[2];

Binary save(GLuint program) {
    Binary b;
    GLint length = 0;
    glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &length);
    if (length <= 0) fail("a program has no binary");
    b.bytes.resize(std::size_t(length));
    GLsizei written = 0;
    glGetProgramBinary(program, length, &written, &b.format, b.bytes.data());
    if (written != length) fail("a binary is %d bytes long instead of %d", written, length);
    glGetProgramBinary(program, length - 1, &written, &b.format, b.bytes.data());
    if (glGetError() != GL_INVALID_OPERATION) fail("a binary went into too little room");
    return b;
}

bool load(GLuint program, const Binary& binary, GLsizei length) {
    glProgramBinary(program, binary.format, binary.bytes.data(), length);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    return status != 0;
}

GLuint loaded(const Binary& binary) {
    const GLuint program = glCreateProgram();
    if (!load(program, binary, GLsizei(binary.bytes.size()))) fail("a program's own binary does not load");
    return program;
}

void savePainted() {
    const GLuint program = buildProgram(
        {{GL_VERTEX_SHADER,
          "#version 330\nin vec2 corner; in vec3 tint; uniform vec4 box = vec4(-0.9, -0.9, 0.5, 0.5); out vec3 color; "
          "out vec2 kept;\n"
          "void main() { color = tint; kept = corner * 3.0; gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n"},
         {GL_FRAGMENT_SHADER,
          "#version 330\nin vec3 color; uniform float shade[2]; layout(std140) uniform Block { vec4 more; };\n"
          "out vec4 first; out vec4 second; void main() { first = vec4(color + shade[1], 1); second = vec4(more.rgb, "
          "1); }\n"}},
        [](unsigned linking) {
            const char* const varyings[] = {"kept", "color"};
            glTransformFeedbackVaryings(linking, 2, varyings, GL_INTERLEAVED_ATTRIBS);
            glBindAttribLocation(linking, kCorner, "corner");
            glBindAttribLocation(linking, kTint, "tint");
            glBindFragDataLocation(linking, 1, "first");
            glBindFragDataLocation(linking, 0, "second");
        });
    glUseProgram(program);
    glUniform4f(glGetUniformLocation(program, "box"), 0, 0, 0, 0); // belongs to this program, not to its binary
    glUseProgram(0);
    painted = save(program);
    glDeleteProgram(program);
}

void saveSeparable() {
    const char* const vertex =
        "#version 430\nlayout(location=3) in vec2 corner; out gl_PerVertex { vec4 gl_Position; };\n"
        "layout(location=0) out vec2 at; uniform vec2 from; void main() { at = corner; gl_Position = vec4(from + "
        "corner * 0.5, 0, 1); }\n";
    const char* const fragment = "#version 430\nlayout(location=0) in vec2 at; out vec4 color; uniform vec3 base;\n"
                                 "void main() { color = vec4(base + vec3(at, 0) * 0.3, 1); }\n";
    const GLuint programs[] = {glCreateShaderProgramv(GL_VERTEX_SHADER, 1, &vertex),
                               glCreateShaderProgramv(GL_FRAGMENT_SHADER, 1, &fragment)};
    for (int i = 0; i < 2; ++i) {
        separable[i] = save(programs[i]);
        glDeleteProgram(programs[i]);
        separate[i] = loaded(separable[i]);
    }
    glGenProgramPipelines(1, &pipeline);
    glUseProgramStages(pipeline, GL_VERTEX_SHADER_BIT, separate[0]);
    glUseProgramStages(pipeline, GL_FRAGMENT_SHADER_BIT, separate[1]);
}

void setUp(Window&) {
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    if (formats < 1) fail("the driver has no format of program binaries");
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    const GLfloat places[] = {0, 0, 1, 0, 0, 1, 1, 1};
    glGenBuffers(1, &corners);
    glBindBuffer(GL_ARRAY_BUFFER, corners);
    glBufferData(GL_ARRAY_BUFFER, sizeof places, places, GL_STATIC_DRAW);
    glVertexAttribPointer(kCorner, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(kCorner);
    glGenBuffers(1, &feedback);
    glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, feedback);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 256, nullptr, GL_DYNAMIC_COPY);
    glGenTextures(2, targets);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    for (unsigned i = 0; i < 2; ++i) {
        glBindTexture(GL_TEXTURE_2D, targets[i]);
        glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, kSize, kSize);
        glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, targets[i], 0);
    }
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    savePainted();
    saveSeparable();
}

void blitTarget(unsigned target, int x) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0 + target);
    glBlitFramebuffer(0, 0, kSize, kSize, x, 100, x + 2 * kSize, 100 + 2 * kSize, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

void drawPainted(const Window& window, int frame) {
    const GLuint program = loaded(painted);
    glUseProgram(program);
    glUniform1f(glGetUniformLocation(program, "shade[1]"), 0.1F * float(frame));
    const GLfloat more[] = {0.2F, 0.9F, 0.1F * float(frame), 1};
    GLuint block = 0;
    glGenBuffers(1, &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 4, block);
    glBufferData(GL_UNIFORM_BUFFER, sizeof more, more, GL_STATIC_DRAW);
    glUniformBlockBinding(program, glGetUniformBlockIndex(program, "Block"), 4);
    glVertexAttrib3f(kTint, 0.7F, 0.2F, 0.3F);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kSize, kSize);
    glClearColor(0, 0, 0.4F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, feedback);
    glBeginTransformFeedback(GL_TRIANGLES);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEndTransformFeedback();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window.width(), window.height());
    blitTarget(0, 20);
    blitTarget(1, 120);
    GLfloat captured[5] = {};
    glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 20, sizeof captured, captured);
    showBits(0, captured[0] + 16 * captured[2]);
    glUseProgram(0);
    glDeleteProgram(program);
    glDeleteBuffers(1, &block);
}

void drawSeparable(int frame) {
    glBindProgramPipeline(pipeline);
    glProgramUniform2f(separate[0], glGetUniformLocation(separate[0], "from"), 0.3F, -0.8F + 0.1F * float(frame));
    glProgramUniform3f(separate[1], glGetUniformLocation(separate[1], "base"), 0.1F, 0.4F, 0.5F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindProgramPipeline(0);
    GLint readBack = 0;
    glGetProgramiv(separate[0], GL_PROGRAM_SEPARABLE, &readBack);
    showBits(1, unsigned(readBack));
}

void loadWrongOnes() {
    const GLuint program = glCreateProgram();
    if (load(program, painted, GLsizei(painted.bytes.size()) - 20)) fail("a binary that is cut off loads");
    if (load(program, painted, 0)) fail("a binary of no bytes loads");
    glProgramBinary(program, 0x1234, painted.bytes.data(), GLsizei(painted.bytes.size()));
    if (glGetError() != GL_INVALID_ENUM) fail("a binary of no format loads");
    glProgramBinary(program, painted.format, painted.bytes.data(), -1);
    if (glGetError() != GL_INVALID_VALUE) fail("a binary of negative length loads");
    glDeleteProgram(program);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Core, 4, 5};
    return runInGlxWindow(argc, argv, spec, setUp, [](Window& window, int frame) {
        glClearColor(0.1F, 0.15F, 0.2F, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        drawPainted(window, frame);
        drawSeparable(frame);
        loadWrongOnes();
    });
}
