// ARB_vertex_program and ARB_fragment_program: environment and local parameters, state bindings, address register, KIL,
// fog and position options, textures, and correct reports of errors.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <cstring>

using namespace programs;

namespace {

GLuint names[6];
GLuint texture;

const char* const kWave = "!!ARBvp1.0\n"
                          "PARAM mvp[4] = { state.matrix.mvp };\n"
                          "PARAM shift = program.local[1];\n"
                          "PARAM table[4] = { program.env[2..5] };\n"
                          "ATTRIB place = vertex.position;\n"
                          "TEMP moved; ADDRESS a;\n"
                          "ARL a.x, vertex.attrib[7].x;\n"
                          "MAD moved, table[a.x], shift, place;\n"
                          "DP4 result.position.x, mvp[0], moved;\n"
                          "DP4 result.position.y, mvp[1], moved;\n"
                          "DP4 result.position.z, mvp[2], moved;\n"
                          "DP4 result.position.w, mvp[3], moved;\n"
                          "MOV result.color, vertex.color;\n"
                          "MUL result.texcoord[0], vertex.position, 0.03125;\nEND\n";
const char* const kInvariant = "!!ARBvp1.0\nOPTION ARB_position_invariant;\n"
                               "MUL result.color, vertex.color, state.material.diffuse;\n"
                               "MOV result.texcoord[0], vertex.texcoord[0];\nEND\n";
const char* const kMix = "!!ARBfp1.0\nPARAM tint = program.env[0];\nTEMP texel, mixed;\n"
                         "TEX texel, fragment.texcoord[0], texture[0], 2D;\n"
                         "LRP mixed, tint.a, texel, fragment.color;\n"
                         "MUL result.color, mixed, tint;\nEND\n";
const char* const kKill = "!!ARBfp1.0\nTEMP t, d;\nPARAM c = program.local[0];\n"
                          "MUL t, fragment.position, 0.125;\nFRC t, t;\nSUB d, t, c;\nKIL d.x;\n"
                          "MOV result.color, t;\nMOV result.color.z, c.w;\nEND\n";
const char* const kFog = "!!ARBfp1.0\nOPTION ARB_fog_linear;\nMOV result.color, fragment.color;\nEND\n";

void give(GLenum target, GLuint name, const char* text) {
    glBindProgramARB(target, name);
    glProgramStringARB(target, GL_PROGRAM_FORMAT_ASCII_ARB, GLsizei(std::strlen(text)), text);
    GLint place = 0;
    glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &place);
    if (place != -1) {
        fail("program wrong at %d: %s", place, reinterpret_cast<const char*>(glGetString(GL_PROGRAM_ERROR_STRING_ARB)));
    }
}

void setUp() {
    glGenProgramsARB(6, names);
    give(GL_VERTEX_PROGRAM_ARB, names[0], kWave);
    give(GL_VERTEX_PROGRAM_ARB, names[1], kInvariant);
    give(GL_FRAGMENT_PROGRAM_ARB, names[2], kMix);
    give(GL_FRAGMENT_PROGRAM_ARB, names[3], kKill);
    give(GL_FRAGMENT_PROGRAM_ARB, names[4], kFog);
    GLubyte texels[4 * 4 * 4];
    Sequence numbers(14);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
}

void strip(float x, float y) {
    glBegin(GL_TRIANGLE_STRIP);
    for (int i = 0; i < 16; ++i) {
        Sequence numbers{unsigned(i)};
        glVertexAttrib1fARB(7, float(i % 4));
        glColor3f(numbers.unit(), numbers.unit(), numbers.unit());
        glTexCoord2f(float(i) * 0.2F, float(i % 2));
        glVertex3f(x + float(i / 2) * 13, y + float(i % 2) * 50, float(i) * 0.05F - 0.4F);
    }
    glEnd();
}

void setParameters(int frame) {
    for (GLuint i = 0; i < 4; ++i) {
        const GLfloat row[] = {float(i) * 2, float(i * unsigned(frame)), 0, 0};
        glProgramEnvParameter4fvARB(GL_VERTEX_PROGRAM_ARB, 2 + i, row);
    }
    glProgramEnvParameter4dARB(GL_FRAGMENT_PROGRAM_ARB, 0, 1, 0.8, 0.5 + 0.1 * frame, 0.5);
    glBindProgramARB(GL_VERTEX_PROGRAM_ARB, names[0]);
    glProgramLocalParameter4fARB(GL_VERTEX_PROGRAM_ARB, 1, 1, 1.5F, 0, 0);
    glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, names[3]);
    const GLdouble local[] = {0.2 + 0.1 * frame, 0, 0, 0.7};
    glProgramLocalParameter4dvARB(GL_FRAGMENT_PROGRAM_ARB, 0, local);
}

void drawAll(int frame) {
    glEnable(GL_VERTEX_PROGRAM_ARB);
    glBindProgramARB(GL_VERTEX_PROGRAM_ARB, names[0]);
    strip(10, 10);
    glEnable(GL_FRAGMENT_PROGRAM_ARB);
    glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, names[2]);
    strip(130, 10);
    glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, names[3]);
    strip(10, 75);
    const GLfloat diffuse[] = {0.9F, 0.5F, 0.2F * float(frame), 1};
    glMaterialfv(GL_FRONT, GL_DIFFUSE, diffuse);
    glBindProgramARB(GL_VERTEX_PROGRAM_ARB, names[1]);
    glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, names[2]);
    strip(130, 75);
    glDisable(GL_VERTEX_PROGRAM_ARB);
    glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, names[4]);
    const GLfloat fog[] = {0.2F, 0.8F, 0.4F, 1};
    glFogfv(GL_FOG_COLOR, fog);
    glFogi(GL_FOG_MODE, GL_LINEAR);
    glFogf(GL_FOG_START, -0.5F);
    glFogf(GL_FOG_END, 0.6F);
    strip(10, 137);
    glDisable(GL_FRAGMENT_PROGRAM_ARB);
    strip(130, 137);
}

// Loads an invalid text: an error and its position are reported, and drawing continues.
void giveWrong() {
    const char* const wrong = "!!ARBvp1.0\nMOV result.position, nothing;\nEND\n";
    glBindProgramARB(GL_VERTEX_PROGRAM_ARB, names[5]);
    glProgramStringARB(GL_VERTEX_PROGRAM_ARB, GL_PROGRAM_FORMAT_ASCII_ARB, GLsizei(std::strlen(wrong)), wrong);
    showBits(37, glGetError());
    GLint place = 0;
    glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &place);
    showBits(36, std::uint32_t(place));
    GLdouble parameter[4] = {};
    glGetProgramEnvParameterdvARB(GL_FRAGMENT_PROGRAM_ARB, 0, parameter);
    showBits(35, float(parameter[2]));
}

} // namespace

int main(int argc, char** argv) {
    return runInGlxWindow(
        argc, argv, {}, [](Window&) { setUp(); },
        [](Window&, int frame) {
            glClearColor(0.1F, 0.1F, 0.2F, 1);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            glMatrixMode(GL_PROJECTION);
            glLoadIdentity();
            glOrtho(0, 250, 0, 190, -1, 1);
            setParameters(frame);
            drawAll(frame);
            giveWrong();
        });
}
