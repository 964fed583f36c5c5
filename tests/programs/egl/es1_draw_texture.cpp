// glDrawTex{s,i,x,f}[v]OES of OpenGL ES 1.1: textured rectangles in window coordinates. Crop rectangles, depth,
// blending, two texture units, viewports without effect, framebuffer objects, rectangles beyond the window, and errors.
#include <EGL/egl.h>
#include <GLES/gl.h>
#include <GLES/glext.h>

#include <array>
#include <cstring>
#include <vector>

#include "tests/programs/support/program.hpp"

using namespace programs;

namespace {

constexpr int kSide = 16;

template <class Function> Function find(const char* name) {
    const auto found = reinterpret_cast<Function>(eglGetProcAddress(name));
    if (!found) fail("%s is not there", name);
    return found;
}

struct DrawTexture {
    PFNGLDRAWTEXSOESPROC s = find<PFNGLDRAWTEXSOESPROC>("glDrawTexsOES");
    PFNGLDRAWTEXIOESPROC i = find<PFNGLDRAWTEXIOESPROC>("glDrawTexiOES");
    PFNGLDRAWTEXXOESPROC x = find<PFNGLDRAWTEXXOESPROC>("glDrawTexxOES");
    PFNGLDRAWTEXFOESPROC f = find<PFNGLDRAWTEXFOESPROC>("glDrawTexfOES");
    PFNGLDRAWTEXSVOESPROC sv = find<PFNGLDRAWTEXSVOESPROC>("glDrawTexsvOES");
    PFNGLDRAWTEXIVOESPROC iv = find<PFNGLDRAWTEXIVOESPROC>("glDrawTexivOES");
    PFNGLDRAWTEXXVOESPROC xv = find<PFNGLDRAWTEXXVOESPROC>("glDrawTexxvOES");
    PFNGLDRAWTEXFVOESPROC fv = find<PFNGLDRAWTEXFVOESPROC>("glDrawTexfvOES");
};

const DrawTexture& drawTexture() {
    static const DrawTexture all;
    return all;
}

GLuint textures[3], framebuffers[2], target;

constexpr GLfixed fixed(float value) { return static_cast<GLfixed>(value * 65536.0F); }

void crop(std::array<GLint, 4> rectangle) {
    glTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_CROP_RECT_OES, rectangle.data());
}

void makeTexture(GLuint texture, GLenum format, int channels, int seed, GLint filter) {
    std::vector<GLubyte> texels(std::size_t(kSide) * kSide * std::size_t(channels));
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = GLubyte((int(i) * 37 + seed) % 256);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GLint(format), kSide, kSide, 0, format, GL_UNSIGNED_BYTE, texels.data());
    crop({0, 0, kSide, kSide});
}

void setUp() {
    const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
    if (!extensions || !std::strstr(extensions, "GL_OES_draw_texture")) fail("GL_OES_draw_texture is not there");
    glGenTextures(3, textures);
    makeTexture(textures[0], GL_RGBA, 4, 11, GL_NEAREST);
    makeTexture(textures[1], GL_RGB, 3, 5, GL_LINEAR);
    makeTexture(textures[2], GL_LUMINANCE, 1, 90, GL_NEAREST);
    find<PFNGLGENFRAMEBUFFERSOESPROC>("glGenFramebuffersOES")(2, framebuffers);
    glGenTextures(1, &target);
    glBindTexture(GL_TEXTURE_2D, target);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 32, 32, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    crop({0, 0, 32, 32});
}

void bindFramebuffer(GLuint framebuffer) {
    find<PFNGLBINDFRAMEBUFFEROESPROC>("glBindFramebufferOES")(GL_FRAMEBUFFER_OES, framebuffer);
}

// Draws one rectangle with each of the eight commands, in a row.
void drawVariants(int frame) {
    const DrawTexture& draw = drawTexture();
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    const auto y = GLshort(5 + frame);
    const GLshort shorts[] = {34, y, 0, 24, 30};
    const GLint ints[] = {94, y, 0, 26, 30};
    const GLfixed fixeds[] = {fixed(154.5F), fixed(5.25F), 0, fixed(24), fixed(30)};
    const GLfloat floats[] = {213.75F, 4.5F, 0, 26.5F, 30.25F};
    draw.s(4, y, 0, 24, 30);
    draw.sv(shorts);
    draw.i(64, y, 0, 24, 30);
    draw.iv(ints);
    draw.x(fixed(124), fixed(5.5F), 0, fixed(24), fixed(30));
    draw.xv(fixeds);
    draw.f(184.25F, 5, 0, 24, 30);
    draw.fv(floats);
}

// Draws parts of a texture, mirrored with negative sizes, one of them larger than the texture.
void drawCrops(int frame) {
    glBindTexture(GL_TEXTURE_2D, textures[1]);
    const std::array<GLint, 4> crops[] = {
        {2, 3, 9, 7}, {kSide, 0, -kSide, kSide}, {0, kSide, kSide, -kSide}, {-4, -4, 24, 24}, {frame, frame, 4, 4}};
    int x = 10;
    for (const auto& rectangle : crops) {
        crop(rectangle);
        drawTexture().i(x, 50, 0, 40, 40);
        x += 45;
    }
    GLint read[4] = {};
    glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_CROP_RECT_OES, read);
    if (read[0] != frame || read[3] != 4) fail("the crop rectangle reads %d and %d", read[0], read[3]);
    crop({0, 0, kSide, kSide});
}

// Draws at depths: 0 and less is the near plane, 1 and more the far plane.
void drawDepths() {
    glEnable(GL_DEPTH_TEST);
    glBindTexture(GL_TEXTURE_2D, textures[2]);
    drawTexture().f(20, 100, 0.5F, 60, 30);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    drawTexture().f(40, 110, 0.75F, 60, 30); // partly hidden
    drawTexture().f(70, 105, -3, 20, 20);
    drawTexture().f(30, 95, 7, 20, 20);
    glDisable(GL_DEPTH_TEST);
}

void drawBlended(int frame) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glTexEnvx(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glColor4ub(255, GLubyte(90 + 30 * frame), 120, 180);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    drawTexture().i(110, 85, 0, 70, 60); // across tiles
    glActiveTexture(GL_TEXTURE1);
    glEnable(GL_TEXTURE_2D);
    glTexEnvx(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glBindTexture(GL_TEXTURE_2D, textures[1]);
    crop({4, 0, 8, 8});
    drawTexture().i(150, 100, 0, 60, 50);
    crop({0, 0, kSide, kSide});
    glDisable(GL_TEXTURE_2D);
    glActiveTexture(GL_TEXTURE0);
    glDisable(GL_BLEND);
    glColor4ub(255, 255, 255, 255);
}

// Checks that neither the viewport nor matrices move a rectangle, and that the scissor cuts it.
void drawCut(int width, int height) {
    glViewport(30, 20, 50, 40);
    glLoadIdentity();
    glTranslatef(0.5F, 0.5F, 0);
    glBindTexture(GL_TEXTURE_2D, textures[1]);
    drawTexture().i(-20, height - 25, 0, 45, 50);
    drawTexture().i(width - 20, height - 30, 0, 400, 300);
    drawTexture().s(-30000, 60, 0, 100, 100);
    glEnable(GL_SCISSOR_TEST);
    glScissor(120, 150, 40, 20);
    drawTexture().i(100, 140, 0, 100, 60);
    glDisable(GL_SCISSOR_TEST);
    glViewport(0, 0, width, height);
    glLoadIdentity();
}

void drawToFramebuffer(int width, int height) {
    bindFramebuffer(framebuffers[0]);
    find<PFNGLFRAMEBUFFERTEXTURE2DOESPROC>("glFramebufferTexture2DOES")(GL_FRAMEBUFFER_OES, GL_COLOR_ATTACHMENT0_OES,
                                                                        GL_TEXTURE_2D, target, 0);
    glViewport(0, 0, 32, 32);
    glClearColorx(fixed(0.6F), 0, fixed(0.3F), fixed(1));
    glClear(GL_COLOR_BUFFER_BIT);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    drawTexture().i(4, 6, 0, 20, 22);
    bindFramebuffer(0);
    glViewport(0, 0, width, height);
    glBindTexture(GL_TEXTURE_2D, target);
    drawTexture().f(200, 100, 0, 48, 48);
}

// Shows errors of empty rectangles, and of an incomplete framebuffer, as a colour.
void showErrors() {
    drawTexture().i(0, 0, 0, 0, 4);
    const GLenum empty = glGetError();
    const GLfloat negative[] = {0, 0, 0, 4, -1};
    drawTexture().fv(negative);
    const GLenum below = glGetError();
    bindFramebuffer(framebuffers[1]);
    drawTexture().i(0, 0, 0, 4, 4);
    const GLenum incomplete = glGetError();
    bindFramebuffer(0);
    drawTexture().i(236, 150, 0, 10, 10);
    const GLenum none = glGetError();
    glEnable(GL_SCISSOR_TEST);
    glScissor(230, 170, 15, 15);
    glClearColor(GLfloat(empty & 15U) / 16, GLfloat(below & 15U) / 16,
                 GLfloat((incomplete & 15U) + 4 * (none & 3U)) / 32, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

void draw(Window& window, int frame) {
    const int width = window.width(), height = window.height();
    glClearColorx(fixed(0.1F), fixed(0.2F), fixed(0.1F), fixed(1));
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_TEXTURE_2D);
    glTexEnvx(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    drawVariants(frame);
    drawCrops(frame);
    drawDepths();
    drawBlended(frame);
    glTexEnvx(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    drawCut(width, height);
    drawToFramebuffer(width, height);
    showErrors();
}

} // namespace

int main(int argc, char** argv) {
    WindowSpec spec;
    spec.profile = Profile::Es;
    spec.major = 1;
    spec.minor = 1;
    return runInEglWindow(
        argc, argv, spec, [](Window&) { setUp(); }, draw);
}
