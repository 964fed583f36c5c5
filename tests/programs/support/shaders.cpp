#define GL_GLEXT_PROTOTYPES 1
#include "tests/programs/support/shaders.hpp"

#include <GL/gl.h>
#include <GL/glext.h>

#include "tests/programs/support/program.hpp"

namespace programs {

unsigned compileShader(unsigned type, const char* source) {
    const GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled != GL_TRUE) {
        char log[2000] = "";
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        fail("shader 0x%04x does not compile: %s", type, log);
    }
    return shader;
}

unsigned buildProgram(std::initializer_list<Stage> stages, const std::function<void(unsigned)>& beforeLink) {
    const GLuint program = glCreateProgram();
    for (const Stage& stage : stages) {
        const GLuint shader = compileShader(stage.type, stage.source);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    if (beforeLink) {
        beforeLink(program);
    }
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        char log[2000] = "";
        glGetProgramInfoLog(program, sizeof log, nullptr, log);
        fail("program does not link: %s", log);
    }
    return program;
}

} // namespace programs
