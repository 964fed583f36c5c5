// Framebuffers with more than 8 bits per channel: framebuffer objects, pbuffers of GLX, and pbuffers of half floats
// through EGL without a window system. Prints sums of the pixels that GL reads from them.
#define EGL_EGLEXT_PROTOTYPES 1
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glx.h>
#include <cstdint>
#include <cstdio>
#include <vector>

using namespace programs;

namespace {

constexpr int kWidth = 150, kHeight = 110;

void require(bool ok, const char* what) {
    if (!ok) {
        fail("cannot use %s", what);
    }
}

// Draws values including some above 1, which half floats keep.
void draw(int seed) {
    Sequence numbers(unsigned(seed) * 5 + 3);
    glViewport(0, 0, kWidth, kHeight);
    glClearColor(0.3F, 1.75F, 0.7F, 0.4F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 60; ++i) {
        glColor4f(numbers.unit(), numbers.unit(), numbers.unit(), numbers.unit());
        glVertex2f(numbers.unit() * 2 - 1, numbers.unit() * 2 - 1);
    }
    glEnd();
}

void readAs(const char* name, GLenum type, size_t pixelBytes) {
    std::vector<unsigned char> pixels(size_t(kWidth) * kHeight * pixelBytes, 0x5a);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, type, pixels.data());
    std::uint64_t sum = 1469598103934665603U;
    for (const unsigned char byte : pixels) {
        sum = (sum ^ byte) * 1099511628211U;
    }
    std::printf("  %s %016llx\n", name, static_cast<unsigned long long>(sum));
    checkNoError(name);
}

void readAll() {
    readAs("bytes", GL_UNSIGNED_BYTE, 4);
    readAs("tens", GL_UNSIGNED_INT_2_10_10_10_REV, 4);
    readAs("shorts", GL_UNSIGNED_SHORT, 8);
    readAs("halves", GL_HALF_FLOAT, 8);
    readAs("floats", GL_FLOAT, 16);
}

// Copies a picture that several nodes drew.
void copyOut() {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 0, 0, kWidth, kHeight, 0);
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    readAs("copied", GL_FLOAT, 16);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
}

// ---- framebuffer objects

void tryObject(GLenum format, const char* name) {
    std::printf("%s\n", name);
    GLuint buffers[2] = {}, framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(2, buffers);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, format, kWidth, kHeight);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, kWidth, kHeight);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    require(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, name);
    draw(1);
    readAll();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteRenderbuffers(2, buffers);
}

void tryObjects() {
    tryObject(GL_RGB10_A2, "RGB10_A2");
    tryObject(GL_RGBA16, "RGBA16");
    tryObject(GL_RGBA16F, "RGBA16F");
    tryObject(GL_RGBA32F, "RGBA32F");
    tryObject(GL_R11F_G11F_B10F, "R11F_G11F_B10F");
    tryObject(GL_RGB565, "RGB565");
}

// ---- pbuffers

void tryGlx(bool& objects) {
    Display* display = openDisplayOnce();
    for (const int alpha : {2, 0}) {
        const int attributes[] = {GLX_DRAWABLE_TYPE,
                                  GLX_PBUFFER_BIT,
                                  GLX_DOUBLEBUFFER,
                                  True,
                                  GLX_RED_SIZE,
                                  10,
                                  GLX_GREEN_SIZE,
                                  10,
                                  GLX_BLUE_SIZE,
                                  10,
                                  GLX_ALPHA_SIZE,
                                  alpha,
                                  GLX_DEPTH_SIZE,
                                  24,
                                  None};
        int count = 0;
        GLXFBConfig* configs = glXChooseFBConfig(display, DefaultScreen(display), attributes, &count);
        require(configs != nullptr && count > 0, "GLX pbuffers of 10 bits per channel");
        const int size[] = {GLX_PBUFFER_WIDTH, kWidth, GLX_PBUFFER_HEIGHT, kHeight, None};
        const GLXPbuffer pbuffer = glXCreatePbuffer(display, configs[0], size);
        const GLXContext context = glXCreateNewContext(display, configs[0], GLX_RGBA_TYPE, nullptr, True);
        require(glXMakeCurrent(display, pbuffer, context), "a GLX pbuffer");
        std::printf("GLX pbuffer, %d bits of alpha or more\n", alpha);
        for (int frame = 0; frame < 2; ++frame) {
            draw(frame);
            readAll();
            copyOut(); // no swap: Mesa's fails on X screens of depth 30
        }
        if (!objects) {
            tryObjects();
        }
        objects = true;
        glXMakeCurrent(display, None, nullptr);
        glXDestroyContext(display, context);
        glXDestroyPbuffer(display, pbuffer);
        XFree(configs);
    }
}

void tryHalfFloats() {
    const EGLDisplay egl = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    require(egl != EGL_NO_DISPLAY && eglInitialize(egl, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API),
            "EGL without a window system");
    const EGLint attributes[] = {EGL_SURFACE_TYPE,
                                 EGL_PBUFFER_BIT,
                                 EGL_RENDERABLE_TYPE,
                                 EGL_OPENGL_BIT,
                                 EGL_COLOR_COMPONENT_TYPE_EXT,
                                 EGL_COLOR_COMPONENT_TYPE_FLOAT_EXT,
                                 EGL_RED_SIZE,
                                 16,
                                 EGL_ALPHA_SIZE,
                                 16,
                                 EGL_DEPTH_SIZE,
                                 24,
                                 EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(egl, attributes, &config, 1, &count) || count == 0) {
        std::printf("EGL has no pbuffers of half floats\n");
        return;
    }
    const EGLint size[] = {EGL_WIDTH, kWidth, EGL_HEIGHT, kHeight, EGL_NONE};
    const EGLSurface pbuffer = eglCreatePbufferSurface(egl, config, size);
    const EGLContext context = eglCreateContext(egl, config, EGL_NO_CONTEXT, nullptr);
    require(eglMakeCurrent(egl, pbuffer, pbuffer, context) == EGL_TRUE, "a pbuffer of half floats");
    std::printf("EGL pbuffer of half floats\n");
    glClampColor(GL_CLAMP_VERTEX_COLOR, GL_FALSE);
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
    for (int frame = 0; frame < 2; ++frame) {
        draw(frame);
        readAll();
        copyOut();
    }
    eglSwapBuffers(egl, pbuffer);
    eglMakeCurrent(egl, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(egl, context);
    eglDestroySurface(egl, pbuffer);
}

} // namespace

int main() {
    bool objects = false;
    tryGlx(objects);
    tryHalfFloats();
    return 0;
}
