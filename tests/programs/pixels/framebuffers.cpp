// Framebuffer objects: rendering to textures and renderbuffers, several targets, blits from and to the window (scaled,
// flipped, depth), resolve, separate clears, invalidation, reads with glCopyTexSubImage.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/shaders.hpp"
#include "tests/programs/support/show.hpp"

using namespace programs;

namespace {

constexpr int kSize = 64;
GLuint shapes, picture, targetsProgram;
GLuint vertexArray;
GLuint colorTextures[4], depthTexture, renderbuffers[3];
GLuint simple, several, multisampled, depthOnly;

void attachTexture(GLuint framebuffer, GLenum attachment, GLuint texture) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void makeTexture(GLuint name, GLint internal, GLenum format, GLenum type) {
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, internal, kSize, kSize, 0, format, type, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void requireComplete(const char* which) {
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        fail("the framebuffer %s is incomplete: 0x%04x", which, status);
    }
}

void makeFramebuffers() {
    glGenTextures(4, colorTextures);
    glGenTextures(1, &depthTexture);
    glGenRenderbuffers(3, renderbuffers);
    GLuint framebuffers[4];
    glGenFramebuffers(4, framebuffers);
    simple = framebuffers[0], several = framebuffers[1];
    multisampled = framebuffers[2], depthOnly = framebuffers[3];
    makeTexture(colorTextures[0], GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    makeTexture(colorTextures[1], GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    makeTexture(colorTextures[2], GL_RGBA16F, GL_RGBA, GL_FLOAT);
    makeTexture(colorTextures[3], GL_RG8, GL_RG, GL_UNSIGNED_BYTE);
    makeTexture(depthTexture, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, kSize, kSize);
    attachTexture(simple, GL_COLOR_ATTACHMENT0, colorTextures[0]);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, renderbuffers[0]);
    requireComplete("simple");
    for (int i = 1; i < 4; ++i) {
        attachTexture(several, GL_COLOR_ATTACHMENT0 + GLenum(i) - 1, colorTextures[i]);
    }
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, renderbuffers[0]);
    requireComplete("several");
    glBindFramebuffer(GL_FRAMEBUFFER, multisampled);
    for (int i = 1; i < 3; ++i) {
        glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[i]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, i == 1 ? GL_RGBA8 : GL_DEPTH_COMPONENT24, kSize, kSize);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, i == 1 ? GL_COLOR_ATTACHMENT0 : GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  renderbuffers[i]);
    }
    requireComplete("multisampled");
    attachTexture(depthOnly, GL_DEPTH_ATTACHMENT, depthTexture);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    requireComplete("depth only");
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void makePrograms() {
    const char* const vertex =
        "#version 400\nuniform int frame; out vec3 color;\n"
        "void main() { int i = gl_VertexID; float a = float(i * (frame + 3)) * 0.7;\n"
        "color = vec3(fract(a), fract(float(i) * 0.37), float(i % 2));\n"
        "gl_Position = vec4(sin(a) * 0.9, cos(a * 1.3) * 0.9, fract(a * 2.1) * 1.8 - 0.9, 1); }\n";
    shapes = buildProgram({{GL_VERTEX_SHADER, vertex},
                           {GL_FRAGMENT_SHADER, "#version 400\nin vec3 color; out vec4 result;\n"
                                                "void main() { result = vec4(color, 1); }\n"}});
    targetsProgram = buildProgram(
        {{GL_VERTEX_SHADER, vertex},
         {GL_FRAGMENT_SHADER,
          "#version 400\nin vec3 color; layout(location=0) out vec4 a; layout(location=1) out vec4 b;\n"
          "layout(location=2) out vec4 c; void main() { a = vec4(color, 1); b = vec4(color.bgr * 1.5, 1);\n"
          "c = vec4(gl_FragCoord.xy / 64.0, 0, 1); }\n"}});
    picture =
        buildProgram({{GL_VERTEX_SHADER, "#version 400\nuniform vec4 box; out vec2 corner; void main() {\n"
                                         "corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                         "gl_Position = vec4(box.xy + corner * box.zw, 0, 1); }\n"},
                      {GL_FRAGMENT_SHADER, "#version 400\nin vec2 corner; uniform sampler2D image; out vec4 result;\n"
                                           "void main() { result = vec4(texture(image, corner).rgb, 1); }\n"}});
}

void drawShapes(GLuint program, int frame, GLsizei count) {
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "frame"), frame);
    glEnable(GL_DEPTH_TEST);
    glDrawArrays(GL_TRIANGLES, 0, count);
    glDisable(GL_DEPTH_TEST);
}

void drawPicture(GLuint texture, int cell) {
    glUseProgram(picture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glUniform4f(glGetUniformLocation(picture, "box"), -0.97F + 0.33F * float(cell % 6), -0.97F + 0.5F * float(cell / 6),
                0.3F, 0.46F);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void renderOffscreen(int frame) {
    glViewport(0, 0, kSize, kSize);
    glBindFramebuffer(GL_FRAMEBUFFER, simple);
    glClearColor(0.3F, 0.3F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    drawShapes(shapes, frame, 12);
    glBindFramebuffer(GL_FRAMEBUFFER, several);
    const GLenum all[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
    glDrawBuffers(3, all);
    for (int i = 0; i < 3; ++i) {
        const GLfloat clear[] = {0.2F * float(i), 0.1F * float(frame), 0.4F, 1};
        glClearBufferfv(GL_COLOR, i, clear);
    }
    const GLfloat far = 1;
    glClearBufferfv(GL_DEPTH, 0, &far);
    drawShapes(targetsProgram, frame + 1, 15);
    glBindFramebuffer(GL_FRAMEBUFFER, multisampled);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    drawShapes(shapes, frame + 2, 9);
    glBindFramebuffer(GL_FRAMEBUFFER, depthOnly);
    glClear(GL_DEPTH_BUFFER_BIT);
    drawShapes(shapes, frame + 3, 12);
}

void blit(GLuint from, GLuint to, const int (&source)[4], const int (&target)[4], GLenum filter) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    glBlitFramebuffer(source[0], source[1], source[2], source[3], target[0], target[1], target[2], target[3],
                      GL_COLOR_BUFFER_BIT, filter);
}

void drawWindow(Window& window, int frame) {
    const int w = window.width();
    const int h = window.height();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, w, h);
    glClearColor(0.1F, 0.1F, 0.2F, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    for (int i = 0; i < 4; ++i) {
        drawPicture(colorTextures[i], i);
    }
    drawPicture(depthTexture, 4);
    // To the window: plain, enlarged, flipped, and a window part to a texture and back again.
    const int whole[4] = {0, 0, kSize, kSize};
    blit(simple, 0, whole, {w / 2, h / 2, w / 2 + kSize, h / 2 + kSize}, GL_NEAREST);
    blit(simple, 0, whole, {w * 3 / 4, h / 2, w - 5, h - 5}, GL_LINEAR);
    blit(simple, 0, {10, 10, 50, 40}, {w / 2 + 40, h - 5, w / 2 + 5, h - 25}, GL_NEAREST);
    // Multisampled: resolved into a texture's framebuffer, and from there.
    blit(multisampled, simple, whole, {0, 0, kSize, kSize}, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    drawPicture(colorTextures[0], 5);
    blit(0, simple, {w / 20, h / 20, w / 20 + kSize, h / 20 + kSize}, {kSize, 0, 0, kSize}, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    drawPicture(colorTextures[0], 12 + frame % 3);
    // Inside of the window.
    blit(0, 0, {5, 5, 45, 35}, {5, h - 45, 85, h - 5}, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindTexture(GL_TEXTURE_2D, colorTextures[1]);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, several);
    glReadBuffer(GL_COLOR_ATTACHMENT2);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 8, 8, 16, 16, 40, 30);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    drawPicture(colorTextures[1], 15);
}

} // namespace

int main(int argc, char** argv) {
    const WindowSpec spec = {Profile::Compatibility, 4, 0};
    return runInGlxWindow(
        argc, argv, spec,
        [](Window&) {
            glGenVertexArrays(1, &vertexArray);
            glBindVertexArray(vertexArray);
            makePrograms();
            makeFramebuffers();
        },
        [](Window& window, int frame) {
            renderOffscreen(frame);
            drawWindow(window, frame);
        });
}
