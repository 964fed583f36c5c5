// Shaders that include named strings (ARB_shading_language_include): by full path, by search path, nested, replaced and
// deleted, shared between contexts.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>
#include <memory>
#include <string>

using namespace programs;

namespace {

const char* const kVertex = "#version 120\nvoid main() { gl_Position = gl_Vertex; }\n";

void name(const std::string& path, const std::string& text, bool terminated) {
    if (terminated)
        glNamedStringARB(GL_SHADER_INCLUDE_ARB, -1, path.c_str(), -1, text.c_str());
    else
        glNamedStringARB(GL_SHADER_INCLUDE_ARB, GLint(path.size()), (path + "x").c_str(), GLint(text.size()),
                         (text + "?").c_str());
}

GLuint compiledWith(const char* fragment, const char* searched) {
    const GLuint program = glCreateProgram();
    const GLuint shaders[] = {compileShader(GL_VERTEX_SHADER, kVertex), glCreateShader(GL_FRAGMENT_SHADER)};
    glShaderSource(shaders[1], 1, &fragment, nullptr);
    if (searched) {
        const GLint length = GLint(std::strlen(searched));
        glCompileShaderIncludeARB(shaders[1], 1, &searched, &length);
    } else {
        glCompileShader(shaders[1]);
    }
    for (const GLuint shader : shaders) {
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) fail("a program with included text does not link");
    return program;
}

void drawWith(const char* fragment, const char* searched, float x) {
    const GLuint program = compiledWith(fragment, searched);
    glUseProgram(program);
    glRectf(x, -0.8F, x + 0.5F, 0.8F);
    glUseProgram(0);
    glDeleteProgram(program);
}

const char* const kByPath =
    "#version 120\n#extension GL_ARB_shading_language_include : require\n#include \"/colours/mixed.glsl\"\n"
    "void main() { gl_FragColor = mixed(); }\n";
const char* const kBySearch =
    "#version 120\n#extension GL_ARB_shading_language_include : require\n#include <tone.glsl>\n"
    "void main() { gl_FragColor = vec4(tone(), 0.3, 0.2, 1); }\n";

} // namespace

int main(int argc, char** argv) {
    std::unique_ptr<Window> other;
    return runInGlxWindow(
        argc, argv, {},
        [&](Window& window) {
            name("/colours/tone.glsl", "float tone() { return 0.75; }\n", true);
            name("/colours/mixed.glsl",
                 "#include \"/colours/tone.glsl\"\nvec4 mixed() { return vec4(0.1, tone(), 0.5, 1.0); }\n", false);
            other = openGlxWindow({}, 16, 16, &window);
            window.makeCurrent();
        },
        [&](Window& window, int frame) {
            glClearColor(0.2F, 0.2F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT);
            other->makeCurrent();
            name("/colours/tone.glsl", "float tone() { return " + std::to_string(0.2 * frame) + "; }\n",
                 frame % 2 == 0);
            name("/once", "float once;", false);
            window.makeCurrent();
            drawWith(kByPath, nullptr, -0.9F);
            drawWith(kBySearch, "/colours", -0.2F);
            glDeleteNamedStringARB(5, "/once?");
            showBits(0, glIsNamedStringARB(-1, "/once") == GL_TRUE ? 1U : 0U);
            glNamedStringARB(GL_SHADER_INCLUDE_ARB, -1, "no path", -1, "x");
            if (glGetError() != GL_INVALID_VALUE) fail("a string got a name that is no path");
        });
}
