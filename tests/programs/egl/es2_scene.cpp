// OpenGL ES 2 through EGL: client arrays, textures of all its formats, cube maps, framebuffers, and the result of
// glReadPixels shown again.
#include <EGL/egl.h>
#include <GLES2/gl2.h>
#include <GLES2/gl2ext.h>

#include "tests/programs/support/matrix.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

#include <vector>

using namespace programs;

namespace {

GLuint textured, colored, cube;
GLuint textures[5], cubeTexture, framebuffer, renderbuffer, indexBuffer;

std::vector<GLubyte> noise(std::size_t count, unsigned seed) {
    std::vector<GLubyte> bytes(count);
    Sequence numbers(seed);
    for (GLubyte& value : bytes) {
        value = numbers.byte();
    }
    return bytes;
}

void clampToEdge(GLenum target) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void makePrograms() {
    const auto bind = [](unsigned program) {
        glBindAttribLocation(program, 0, "place");
        glBindAttribLocation(program, 1, "extra");
    };
    textured = buildProgram(
        {{GL_VERTEX_SHADER, "attribute vec2 place; attribute vec2 extra; uniform vec2 offset; varying vec2 at;\n"
                            "void main() { at = extra; gl_Position = vec4(place + offset, 0.0, 1.0); }\n"},
         {GL_FRAGMENT_SHADER, "precision mediump float; varying vec2 at; uniform sampler2D image;\n"
                              "void main() { gl_FragColor = vec4(texture2D(image, at).rgb, 1.0); }\n"}},
        bind);
    colored = buildProgram(
        {{GL_VERTEX_SHADER, "attribute vec4 place; attribute vec4 extra; uniform mat4 matrix; varying vec4 tint;\n"
                            "void main() { tint = extra; gl_PointSize = 5.0; gl_Position = matrix * place; }\n"},
         {GL_FRAGMENT_SHADER,
          "precision highp float; varying vec4 tint;\n"
          "void main() { gl_FragColor = tint * vec4(fract(gl_FragCoord.xy / 16.0) * 0.3 + 0.7, 1.0, 1.0); }\n"}},
        bind);
    cube =
        buildProgram({{GL_VERTEX_SHADER,
                       "attribute vec2 place; attribute vec2 extra; uniform vec2 offset; varying vec3 at;\n"
                       "void main() { at = vec3(extra - 0.5, 0.4); gl_Position = vec4(place + offset, 0.0, 1.0); }\n"},
                      {GL_FRAGMENT_SHADER, "precision mediump float; varying vec3 at; uniform samplerCube image;\n"
                                           "void main() { gl_FragColor = textureCube(image, at); }\n"}},
                     bind);
}

void makeTextures() {
    const GLenum formats[5][2] = {{GL_RGBA, GL_UNSIGNED_BYTE},
                                  {GL_RGB, GL_UNSIGNED_SHORT_5_6_5},
                                  {GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4},
                                  {GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE},
                                  {GL_RGB, GL_UNSIGNED_BYTE}};
    glGenTextures(5, textures);
    for (unsigned i = 0; i < 5; ++i) {
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        clampToEdge(GL_TEXTURE_2D);
        glPixelStorei(GL_UNPACK_ALIGNMENT, i == 4 ? 1 : 4);
        glTexImage2D(GL_TEXTURE_2D, 0, GLint(formats[i][0]), 16, 16, 0, formats[i][0], formats[i][1],
                     noise(1024, i).data());
    }
    glGenTextures(1, &cubeTexture);
    glBindTexture(GL_TEXTURE_CUBE_MAP, cubeTexture);
    clampToEdge(GL_TEXTURE_CUBE_MAP);
    for (unsigned face = 0; face < 6; ++face) {
        glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGB, 4, 4, 0, GL_RGB, GL_UNSIGNED_BYTE,
                     noise(48, face + 9).data());
    }
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(1, &renderbuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, 16, 16);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[4], 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, renderbuffer);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        fail("the framebuffer is incomplete");
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    const GLushort order[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    glGenBuffers(1, &indexBuffer);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof order, order, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

void drawTextured(GLuint program, GLenum target, GLuint texture, float x, float y) {
    const GLfloat places[] = {0, 0, 0.35F, 0, 0, 0.4F, 0.35F, 0.4F};
    const GLubyte corners[] = {0, 0, 255, 0, 0, 255, 255, 255};
    glUseProgram(program);
    glBindTexture(target, texture);
    glUniform2f(glGetUniformLocation(program, "offset"), x, y);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, places);
    glVertexAttribPointer(1, 2, GL_UNSIGNED_BYTE, GL_TRUE, 0, corners);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void drawColored(int frame, GLenum mode) {
    GLfloat vertices[9 * 6];
    Sequence numbers(unsigned(frame) + 3);
    for (GLfloat& value : vertices) {
        value = numbers.unit() * 1.6F - 0.8F;
    }
    const Matrix matrix = multiply(rotationZ(float(frame) * 0.2F), scaling(1, 0.8F, 0.5F));
    glUseProgram(colored);
    glUniformMatrix4fv(glGetUniformLocation(colored, "matrix"), 1, GL_FALSE, matrix.data());
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 24, vertices);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 24, vertices + 3);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer);
    glDrawElements(mode, 9, GL_UNSIGNED_SHORT, nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

template <class F> F entry(const char* name) { return reinterpret_cast<F>(eglGetProcAddress(name)); }

// EXT_occlusion_query_boolean, which the nodes answer: draws a green box where a query counted samples, a red one
// elsewhere.
void drawCounted(int frame, int x, bool nothing) {
    static const auto gen = entry<PFNGLGENQUERIESEXTPROC>("glGenQueriesEXT");
    static const auto begin = entry<PFNGLBEGINQUERYEXTPROC>("glBeginQueryEXT");
    static const auto end = entry<PFNGLENDQUERYEXTPROC>("glEndQueryEXT");
    static const auto result = entry<PFNGLGETQUERYOBJECTUIVEXTPROC>("glGetQueryObjectuivEXT");
    static const auto drop = entry<PFNGLDELETEQUERIESEXTPROC>("glDeleteQueriesEXT");
    GLuint query = 0, any = 7;
    gen(1, &query);
    begin(GL_ANY_SAMPLES_PASSED_EXT, query);
    if (nothing) glEnable(GL_SCISSOR_TEST), glScissor(0, 0, 0, 0);
    drawColored(frame, GL_TRIANGLES);
    glDisable(GL_SCISSOR_TEST);
    end(GL_ANY_SAMPLES_PASSED_EXT);
    result(query, GL_QUERY_RESULT_EXT, &any);
    drop(1, &query);
    glEnable(GL_SCISSOR_TEST);
    glScissor(x, 2, 12, 12);
    glClearColor(any == 0 ? 1.0F : 0.0F, any == 1 ? 1.0F : 0.0F, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

void drawAll(Window& window, int frame) {
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, 16, 16);
    glClearColor(0.1F * float(frame), 0.5F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    drawColored(frame + 7, GL_TRIANGLES);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window.width(), window.height());
    glClearColor(0.1F, 0.1F, 0.25F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    drawColored(frame, GL_TRIANGLES);
    glDisable(GL_DEPTH_TEST);
    drawCounted(frame + 3, 2, false);
    drawCounted(frame + 3, 20, true);
    drawColored(frame + 1, GL_LINE_LOOP);
    drawColored(frame + 2, GL_POINTS);
    for (int i = 0; i < 5; ++i) {
        drawTextured(textured, GL_TEXTURE_2D, textures[i], -0.97F + 0.39F * float(i), -0.95F);
    }
    drawTextured(cube, GL_TEXTURE_CUBE_MAP, cubeTexture, -0.97F, 0.55F);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 3, 3, 5, 5, GL_RGBA, GL_UNSIGNED_BYTE, noise(100, 30 + unsigned(frame)).data());
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 8, 8, window.width() / 2, window.height() / 2, 8, 8);
    drawTextured(textured, GL_TEXTURE_2D, textures[0], -0.5F, 0.55F);
    std::vector<GLubyte> pixels(16 * 16 * 4);
    glReadPixels(window.width() / 3, window.height() / 3, 16, 16, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    drawTextured(textured, GL_TEXTURE_2D, textures[0], 0, 0.55F);
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.profile = Profile::Es;
    spec.major = 2;
    return runInEglWindow(
        argc, argv, spec,
        [](Window&) {
            makePrograms();
            makeTextures();
        },
        drawAll);
}
