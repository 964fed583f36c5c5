// OpenGL ES 3.1 without geometry shaders: a draw that overruns the transform feedback buffers is an error and draws
// nothing.
#include <GLES3/gl31.h>
#include <cstdlib>

#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kTriangles = 5; // capacity of the buffer
GLuint program, buffer, vertexArray;
GLint fromUniform;

void setUp() {
    program = buildProgram({{GL_VERTEX_SHADER, "#version 310 es\nuniform vec2 from; out vec4 kept; void main() {\n"
                                               "vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1); kept = vec4(from + c "
                                               "* 0.25, 0.0, 1.0); gl_Position = kept; }\n"},
                            {GL_FRAGMENT_SHADER, "#version 310 es\nprecision highp float; in vec4 kept; out vec4 o; "
                                                 "void main() { o = vec4(abs(kept.xy), 0.4, 1.0); }\n"}},
                           [](unsigned linking) {
                               const char* const name = "kept";
                               glTransformFeedbackVaryings(linking, 1, &name, GL_INTERLEAVED_ATTRIBS);
                           });
    fromUniform = glGetUniformLocation(program, "from");
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffer);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, kTriangles * 48, nullptr, GL_DYNAMIC_COPY);
    glUseProgram(program);
}

void draw(int frame) {
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    glBeginTransformFeedback(GL_TRIANGLES);
    unsigned errors = 0;
    int drawn = 0;
    const auto next = [&] {
        errors = errors << 1U | (glGetError() == GL_INVALID_OPERATION ? 1U : 0U);
        ++drawn;
        glUniform2f(fromUniform, -0.9F + 0.28F * float(drawn % 6),
                    -0.8F + 0.05F * float(frame) + 0.3F * float(drawn / 6));
    };
    next();
    for (int i = 0; i < 4; ++i) {
        glDrawArrays(GL_TRIANGLES, 0, 3);
        next();
    }
    glDrawArraysInstanced(GL_TRIANGLES, 0, 3, 2); // one too many
    next();
    glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, nullptr); // never permitted during transform feedback
    next();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    next();
    glDrawArrays(GL_TRIANGLES, 0, 3); // one too many
    next();
    glEndTransformFeedback();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    next();
    showBits(0, errors);
}

} // namespace

int main(int argc, char** argv) {
    setenv("MESA_EXTENSION_OVERRIDE",
           "-GL_OES_geometry_shader -GL_EXT_geometry_shader -GL_OES_tessellation_shader -GL_EXT_tessellation_shader",
           1);
    WindowSpec spec;
    spec.profile = Profile::Es;
    spec.major = 3;
    spec.minor = 1;
    return runInEglWindow(
        argc, argv, spec, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.2F, 0.1F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            draw(frame);
        });
}
