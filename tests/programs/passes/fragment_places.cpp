// Fills the window with fragments that use only their position. Origins are at the lower left and the upper left,
// centres at halves and at integers, in GLSL (in two texts) and in assembly. Each bit of a position is visible, and
// also the texture level that the distance of positions selects.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>
#include <string>
#include <vector>

using namespace programs;

namespace {

constexpr int kPlaced = 3, kShaders = 4, kAssembled = 3;
constexpr int kTexels = 64;
GLuint shaders[kShaders];
GLuint assembled[kAssembled];

const char* const kDeclared[kPlaced] = {
    "",
    "layout(origin_upper_left) in vec4 gl_FragCoord;\n",
    "layout(origin_upper_left, pixel_center_integer) in vec4 gl_FragCoord;\n",
};
const char* const kOptions[kAssembled] = {"", "OPTION ARB_fragment_coord_origin_upper_left;\n",
                                          "OPTION ARB_fragment_coord_pixel_center_integer;\n"};

// Makes a texture with a colour per level, some texels darker.
void makeLevels() {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    for (int level = 0, size = kTexels; size > 0; ++level, size /= 2) {
        std::vector<GLubyte> pixels(std::size_t(size) * std::size_t(size) * 4);
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = GLubyte((level + int(i % 4)) % 3 * 100 + (i / 4 % 3 == 0 ? 55 : 0));
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    }
}

void setUp() {
    makeLevels();
    shaders[kPlaced] =
        buildProgram({{GL_VERTEX_SHADER, "#version 120\nvoid main() { gl_Position = gl_Vertex; }\n"},
                      {GL_FRAGMENT_SHADER, "#version 120\nuniform sampler2D levels;\nvoid main() { gl_FragColor = "
                                           "texture2D(levels, gl_FragCoord.xy / 40.0); }\n"}});
    for (int i = 0; i < kPlaced; ++i) {
        const std::string fragment =
            std::string("#version 150 compatibility\n") + kDeclared[i] +
            "vec2 across();\nvoid main() { vec2 p = vec2(gl_FragCoord.x, across().y); gl_FragColor = vec4(fract(p / "
            "16.0), fract((floor(p.x / 16.0) + 7.0 * floor(p.y / 16.0)) / 32.0), 1.0); }\n";
        const std::string other =
            std::string("#version 150 compatibility\n") + kDeclared[i] + "vec2 across() { return gl_FragCoord.xy; }\n";
        shaders[i] =
            buildProgram({{GL_VERTEX_SHADER, "#version 150 compatibility\nvoid main() { gl_Position = gl_Vertex; }\n"},
                          {GL_FRAGMENT_SHADER, fragment.c_str()},
                          {GL_FRAGMENT_SHADER, other.c_str()}});
    }
    glGenProgramsARB(kAssembled, assembled);
    for (int i = 0; i < kAssembled; ++i) {
        const std::string text = std::string("!!ARBfp1.0\n") + kOptions[i] +
                                 "TEMP p, q;\nMUL p, fragment.position, 0.0625;\nFRC q, p;\nFLR p, p;\nDP4 p.z, p, "
                                 "{0.03125, 0.21875, 0, 0};\nFRC q.z, p;\nMOV q.z, q.x;\n"
                                 "MOV result.color, q;\nEND\n";
        glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, assembled[i]);
        glProgramStringARB(GL_FRAGMENT_PROGRAM_ARB, GL_PROGRAM_FORMAT_ASCII_ARB, GLsizei(text.size()), text.data());
    }
}

void everything() { glRectf(-1, -1, 1, 1); }

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {Profile::Compatibility, 3, 2}, [](Window&) { setUp(); },
        [](Window& window, int frame) {
            glViewport(0, 0, window.width(), window.height());
            glClear(GL_COLOR_BUFFER_BIT);
            glUseProgram(shaders[frame % kShaders]);
            everything();
            glUseProgram(0);
            // The assembly program adds its own colour to a third of each.
            glEnable(GL_FRAGMENT_PROGRAM_ARB);
            glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, assembled[frame % kAssembled]);
            glEnable(GL_BLEND);
            glBlendColor(0.5F, 0.5F, 0.5F, 0.5F);
            glBlendFunc(GL_CONSTANT_COLOR, GL_CONSTANT_COLOR);
            everything();
            glDisable(GL_BLEND);
            glDisable(GL_FRAGMENT_PROGRAM_ARB);
        });
}
