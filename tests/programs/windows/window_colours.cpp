// Windows of each kind that the display has: alpha, 5, 8 and 10 bits per channel, samples, GLX and EGL. Prints sums of
// the pixels that GL reads and copies from them with lossless types, and of the pixels that the X server shows.
#define EGL_EGLEXT_PROTOTYPES 1
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"
#include "tests/programs/support/x_window.hpp"

#include <EGL/egl.h>
#include <GL/glx.h>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

using namespace programs;

namespace {

constexpr int kWidth = 150, kHeight = 110; // several tiles, none of complete blocks
constexpr int kFrames = 3;

using Bytes = std::vector<unsigned char>;

std::uint64_t sumOf(const Bytes& bytes) {
    std::uint64_t sum = 1469598103934665603U;
    for (const unsigned char byte : bytes) {
        sum = (sum ^ byte) * 1099511628211U;
    }
    return sum;
}

struct Kind {
    std::string name;
    XVisualInfo visual;
    int alphaBits, samples;
    bool desktop = true, es3 = false;
    bool readsFront = true; // with Mesa's software driver, front buffers of EGL hold uninitialised memory
    std::function<void(::Window)> open;
    std::function<void()> swap, close;
};

// ---- drawing

// Draws with scissored clears, which every API has: neighbouring values of 10 bits, and any alpha.
void drawBoxes(int frame) {
    Sequence numbers(unsigned(frame) * 7 + 1);
    glViewport(0, 0, kWidth, kHeight);
    glClearColor(0.3F, 0.5F, 0.7F, 0.25F * float(frame % 4));
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 120; ++i) {
        glScissor(i % 12 * 13, i / 12 * 11, 12, 10);
        glClearColor(numbers.unit(), float(i * 8 + frame) / 1023, numbers.unit(), numbers.unit());
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
}

// Draws gradients of all channels, and blends with the window's own alpha.
void drawSlopes(int frame) {
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glBegin(GL_QUADS);
    glColor4f(0, 0.1F, 1, 0.1F);
    glVertex2f(-0.8F, -0.7F);
    glColor4f(1, 0.2F, 0, 0.9F);
    glVertex2f(0.7F, -0.8F);
    glColor4f(0.5F, 1, 0, 1);
    glVertex2f(0.9F, 0.6F);
    glColor4f(0, 0, 0.33F, 0);
    glVertex2f(-0.6F, 0.9F);
    glEnd();
    glEnable(GL_BLEND);
    glBlendFunc(GL_DST_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glColor4f(0.9F, 0.1F * float(frame), 0.4F, 0.3F);
    glRectf(-0.3F, -0.9F, 0.35F, 0.8F);
    glDisable(GL_BLEND);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
    glColor4f(0, 0, 0, 0.8F);
    glRectf(-0.9F, 0.1F, 0.5F, 0.3F);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

// ---- reading

void readAs(const char* name, GLenum type, size_t pixelBytes) {
    Bytes pixels(size_t(kWidth) * kHeight * pixelBytes, 0x5a);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, type, pixels.data());
    const GLenum error = glGetError();
    std::printf("  %s %016llx%s\n", name, static_cast<unsigned long long>(sumOf(pixels)), error ? " error" : "");
}

void readAll(const Kind& kind) {
    readAs("bytes", GL_UNSIGNED_BYTE, 4);
    if (kind.desktop || (kind.es3 && kind.visual.bits_per_rgb == 10)) {
        readAs("tens", GL_UNSIGNED_INT_2_10_10_10_REV, 4);
    }
    if (kind.desktop) {
        readAs("shorts", GL_UNSIGNED_SHORT, 8);
        readAs("floats", GL_FLOAT, 16);
    }
}

// Copies the whole window, which no single node has. Samples are averaged to the window's bits, so the copy has no
// more.
void copyOut(const Kind& kind) {
    const GLenum samplesFormat = kind.visual.depth == 30 ? GL_RGB10_A2 : GL_RGBA8;
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, kind.samples > 0 ? samplesFormat : GLenum{GL_RGBA16}, 0, 0, kWidth, kHeight, 0);
    Bytes texels(size_t(kWidth) * kHeight * 8);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_SHORT, texels.data());
    std::printf("  copied %016llx\n", static_cast<unsigned long long>(sumOf(texels)));
    glDeleteTextures(1, &texture);
    checkNoError("copying the window");
}

// Returns the bits of the window's channels, without bits that drivers leave undefined.
std::uint32_t channelBits(const Kind& kind) {
    const auto colours = std::uint32_t(kind.visual.red_mask | kind.visual.green_mask | kind.visual.blue_mask);
    return kind.visual.depth == 32 && kind.alphaBits > 0 ? ~0U : colours;
}

void seeWindow(const Kind& kind, ::Window window) {
    XImage* image = XGetImage(openDisplayOnce(), window, 0, 0, kWidth, kHeight, AllPlanes, ZPixmap);
    if (image == nullptr) {
        fail("the X server gives no image of the window");
    }
    Bytes seen;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const std::uint32_t pixel = std::uint32_t(XGetPixel(image, x, y)) & channelBits(kind);
            for (int shift = 0; shift < 32; shift += 8) {
                seen.push_back(static_cast<unsigned char>(pixel >> shift));
            }
        }
    }
    std::printf("  seen %016llx, depth %d\n", static_cast<unsigned long long>(sumOf(seen)), image->depth);
    XDestroyImage(image);
}

void tryKind(const Kind& kind) {
    std::printf("%s\n", kind.name.c_str());
    const XWindow window(kind.visual, 0, 0, kWidth, kHeight);
    kind.open(window.id());
    for (int frame = 0; frame < kFrames; ++frame) {
        drawBoxes(frame);
        if (kind.desktop) {
            drawSlopes(frame);
        }
        readAll(kind);
        if (kind.desktop) {
            copyOut(kind);
        }
        checkNoError("drawing");
        kind.swap();
        seeWindow(kind, window.id());
        if (kind.readsFront) {
            glReadBuffer(GL_FRONT);
            readAs("front", GL_UNSIGNED_BYTE, 4);
            glReadBuffer(GL_BACK);
        }
    }
    kind.close();
}

// ---- kinds of windows

std::string nameOf(const char* system, int red, int alpha, int samples, int depth) {
    char name[100];
    std::snprintf(name, sizeof name, "%s: %d bits per channel, %d of alpha, %d samples, depth %d", system, red, alpha,
                  samples, depth);
    return name;
}

// Tests the first configuration of each kind: drivers show others with red and blue exchanged.
void tryGlx() {
    Display* display = openDisplayOnce();
    int count = 0;
    GLXFBConfig* configs = glXGetFBConfigs(display, DefaultScreen(display), &count);
    std::set<std::string> tried;
    for (int i = 0; i < count; ++i) {
        const GLXFBConfig config = configs[i];
        const auto query = [&](int name) {
            int value = 0;
            return glXGetFBConfigAttrib(display, config, name, &value) == 0 ? value : 0;
        };
        const int samples = query(GLX_SAMPLES);
        XVisualInfo* visual = glXGetVisualFromFBConfig(display, config);
        if (visual == nullptr || !query(GLX_DOUBLEBUFFER) || query(GLX_DEPTH_SIZE) != 24 ||
            query(GLX_STENCIL_SIZE) != 8 || query(GLX_ACCUM_RED_SIZE) != 0) {
            continue;
        }
        if (samples != 0 && (samples != 4 || query(GLX_ALPHA_SIZE) == 0)) {
            continue;
        }
        Kind kind{nameOf("GLX", query(GLX_RED_SIZE), query(GLX_ALPHA_SIZE), samples, visual->depth),
                  *visual,
                  query(GLX_ALPHA_SIZE),
                  samples,
                  true,
                  false,
                  true,
                  {},
                  {},
                  {}};
        if (!tried.insert(kind.name).second) {
            continue;
        }
        GLXContext context = glXCreateNewContext(display, config, GLX_RGBA_TYPE, nullptr, True);
        ::Window window = 0;
        kind.open = [&](::Window id) {
            window = id;
            if (!glXMakeCurrent(display, id, context)) {
                fail("glXMakeCurrent failed");
            }
        };
        kind.swap = [&] { glXSwapBuffers(display, window); };
        kind.close = [&] {
            glXMakeCurrent(display, None, nullptr);
            glXDestroyContext(display, context);
        };
        tryKind(kind);
    }
    XFree(configs);
}

struct EglApi {
    const char* name;
    EGLenum api;
    EGLint renderable, major;
};

void tryEgl(const EglApi& api) {
    Display* x = openDisplayOnce();
    const EGLDisplay egl = eglGetDisplay(reinterpret_cast<EGLNativeDisplayType>(x));
    if (!eglInitialize(egl, nullptr, nullptr) || !eglBindAPI(api.api)) {
        fail("no EGL");
    }
    const EGLint attributes[] = {
        EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_RENDERABLE_TYPE, api.renderable, EGL_DEPTH_SIZE, 24, EGL_NONE};
    EGLConfig configs[200];
    EGLint count = 0;
    eglChooseConfig(egl, attributes, configs, 200, &count);
    std::set<std::string> tried;
    for (int i = 0; i < count; ++i) {
        const EGLConfig config = configs[i];
        const auto query = [&](EGLint name) {
            EGLint value = 0;
            return eglGetConfigAttrib(egl, config, name, &value) ? value : 0;
        };
        XVisualInfo wanted{};
        wanted.visualid = VisualID(query(EGL_NATIVE_VISUAL_ID));
        int visuals = 0;
        XVisualInfo* visual = XGetVisualInfo(x, VisualIDMask, &wanted, &visuals);
        if (visual == nullptr || query(EGL_SAMPLES) != 0) {
            continue;
        }
        Kind kind{nameOf(api.name, query(EGL_RED_SIZE), query(EGL_ALPHA_SIZE), 0, visual->depth),
                  *visual,
                  query(EGL_ALPHA_SIZE),
                  0,
                  api.api == EGL_OPENGL_API,
                  api.major == 3,
                  false,
                  {},
                  {},
                  {}};
        kind.visual.bits_per_rgb = query(EGL_RED_SIZE);
        if (!tried.insert(kind.name).second) {
            continue;
        }
        const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, api.major, EGL_NONE};
        const EGLContext context = eglCreateContext(egl, config, EGL_NO_CONTEXT, api.major != 0 ? version : nullptr);
        EGLSurface surface = EGL_NO_SURFACE;
        kind.open = [&](::Window id) {
            surface = eglCreateWindowSurface(egl, config, id, nullptr);
            if (eglMakeCurrent(egl, surface, surface, context) != EGL_TRUE) {
                fail("eglMakeCurrent failed (EGL error 0x%04x)", unsigned(eglGetError()));
            }
        };
        kind.swap = [&] { eglSwapBuffers(egl, surface); };
        kind.close = [&] {
            eglMakeCurrent(egl, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
            eglDestroySurface(egl, surface);
            eglDestroyContext(egl, context);
        };
        tryKind(kind);
    }
}

} // namespace

int main() {
    tryGlx();
    tryEgl({"EGL", EGL_OPENGL_API, EGL_OPENGL_BIT, 0});
    tryEgl({"OpenGL ES 3", EGL_OPENGL_ES_API, EGL_OPENGL_ES3_BIT, 3});
    tryEgl({"OpenGL ES 2", EGL_OPENGL_ES_API, EGL_OPENGL_ES2_BIT, 2});
    return 0;
}
