// The scene of pass_scene with OpenGL ES 2, which has no fractional viewports: shaders move the picture. --draw
// textured: its colours come from a texture with a colour per level.
#include <EGL/egl.h>
#include <GLES2/gl2.h>
#include <vector>

#include "tests/programs/passes/pass_options.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"

using namespace programs;

namespace {

PassOptions options;
GLuint scene = 0, overlay = 0;

bool textured() { return options.draw == "textured"; }

void makeLevels() {
    constexpr int kLevels = 8;
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    for (int level = 0; level < kLevels; ++level) {
        const int size = 1 << (kLevels - 1 - level);
        std::vector<unsigned char> texels(static_cast<size_t>(size) * static_cast<size_t>(size) * 4,
                                          static_cast<unsigned char>(255 - level * 30));
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
}

void setUp() {
    if (textured()) makeLevels();
    const char* const fragment =
        textured() ? "precision mediump float; varying vec3 tint; uniform sampler2D s; void main() { gl_FragColor = "
                     "texture2D(s, tint.xy * 4.0) * vec4(tint, 1.0); }\n"
                   : "precision mediump float; varying vec3 tint; void main() { gl_FragColor = vec4(tint, 1.0); }\n";
    const auto bind = [](unsigned p) { glBindAttribLocation(p, 0, "place"), glBindAttribLocation(p, 1, "tone"); };
    scene = buildProgram(
        {{GL_VERTEX_SHADER,
          "attribute vec3 place; attribute vec3 tone; uniform mat4 whole; uniform vec4 by; varying vec3 tint;\n"
          "void main() { tint = tone; gl_Position = whole * vec4(place, 1.0); gl_Position.xy += gl_Position.xy * by.xy "
          "+ by.zw * gl_Position.w; }\n"},
         {GL_FRAGMENT_SHADER, fragment}},
        bind);
    overlay =
        buildProgram({{GL_VERTEX_SHADER, "attribute vec3 place; uniform vec4 by; varying vec3 tint;\n"
                                         "void main() { tint = vec3(place.xy + 1.0, 0.5); gl_Position = vec4(place, "
                                         "1.0); gl_Position.xy += gl_Position.xy * by.xy + by.zw * gl_Position.w; }\n"},
                      {GL_FRAGMENT_SHADER, fragment}},
                     bind);
}

void use(GLuint program, const Window& window) {
    glUseProgram(program);
    glUniform4f(glGetUniformLocation(program, "by"), 0, 0, 2 * options.moveX / float(window.width()),
                2 * options.moveY / float(window.height()));
}

void draw(const Window& window, int frame) {
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.15F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    use(scene, window);
    const Matrix whole = multiply(projectionOf(options, window.width(), window.height()), modelViewOf(options, frame));
    glUniformMatrix4fv(glGetUniformLocation(scene, "whole"), 1, GL_FALSE, whole.data());
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 24, sceneVertices());
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 24, sceneVertices() + 3);
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    glDrawArrays(GL_TRIANGLES, 0, kSceneVertices);
    glDisableVertexAttribArray(1);
    glDisable(GL_DEPTH_TEST);
    use(overlay, window);
    const GLfloat corners[] = {-1, -1, 0, 0, -1, 0, -1, 0, 0, 0, 0, 0};
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, corners);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

} // namespace

int main(int argc, char** argv) {
    options = takePassOptions(argc, argv);
    WindowSpec spec;
    spec.profile = Profile::Es;
    spec.major = 2;
    return runInEglWindow(
        argc, argv, spec, [](Window&) { setUp(); }, [](Window& window, int frame) { draw(window, frame); });
}
