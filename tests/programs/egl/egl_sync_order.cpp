// Two threads whose contexts share only an image. EGL syncs keep them in step: fences in one direction, reusable syncs
// in the other.
#define EGL_EGLEXT_PROTOTYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>

using namespace programs;

namespace {

constexpr int kSize = 32;
constexpr int kRounds = 20; // per frame
constexpr EGLTime kPatienceNs = 20'000'000'000ULL;

EGLDisplay display;
EGLContext painter;
EGLImage image;

PFNEGLCREATESYNCKHRPROC createReusable;
PFNEGLCLIENTWAITSYNCKHRPROC waitReusable;
PFNEGLSIGNALSYNCKHRPROC signalReusable;
PFNEGLDESTROYSYNCKHRPROC destroyReusable;

template <class F> void find(F& function, const char* name) {
    function = reinterpret_cast<F>(eglGetProcAddress(name));
    if (function == nullptr) {
        fail("no %s", name);
    }
}

std::mutex mutex;
std::condition_variable changed;
EGLSync painted = EGL_NO_SYNC;
EGLSyncKHR taken = EGL_NO_SYNC_KHR; // signalled when the picture has been used

void paint(unsigned round) {
    Sequence numbers(round);
    for (int i = 0; i < 6; ++i) {
        fillRectangle(int(numbers.next() % 24), int(numbers.next() % 24), 9, 7,
                      {float(numbers.byte()) / 255, float(numbers.byte()) / 255, 0.6F});
    }
}

void runPainter(unsigned rounds) {
    eglBindAPI(EGL_OPENGL_API);
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, painter) != EGL_TRUE) {
        fail("eglMakeCurrent in the painting thread failed (EGL error 0x%04x)", eglGetError());
    }
    for (unsigned round = 0; round < rounds; ++round) {
        if (waitReusable(display, taken, 0, EGL_FOREVER_KHR) != EGL_CONDITION_SATISFIED_KHR) {
            fail("the drawing thread did not take a picture");
        }
        signalReusable(display, taken, EGL_UNSIGNALED_KHR);
        paint(round);
        const EGLSync sync = eglCreateSync(display, EGL_SYNC_FENCE, nullptr);
        const std::lock_guard<std::mutex> lock(mutex);
        painted = sync;
        changed.notify_all();
    }
    checkNoError("in the painting thread");
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

EGLSync takePainted() {
    std::unique_lock<std::mutex> lock(mutex);
    changed.wait(lock, [] { return painted != EGL_NO_SYNC; });
    const EGLSync sync = painted;
    painted = EGL_NO_SYNC;
    return sync;
}

// Creates the painter's context, a texture to paint into, and an image of the texture.
void makePainter() {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    eglBindAPI(EGL_OPENGL_API);
    eglChooseConfig(display, wanted, &config, 1, &count);
    painter = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
    if (painter == EGL_NO_CONTEXT || eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, painter) != EGL_TRUE) {
        fail("no context without a surface (EGL error 0x%04x)", eglGetError());
    }
    GLuint texture = 0, framebuffer = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glFinish();
    image = eglCreateImage(display, painter, EGL_GL_TEXTURE_2D,
                           reinterpret_cast<EGLClientBuffer>(std::uintptr_t{texture}), nullptr);
    if (image == EGL_NO_IMAGE) {
        fail("no image (EGL error 0x%04x)", eglGetError());
    }
}

void drawImage(int column, int row) {
    const float x = -1 + 0.4F * float(column), y = -1 + 0.5F * float(row);
    glBegin(GL_QUADS);
    for (int i = 0; i < 4; ++i) {
        const float u = i == 1 || i == 2 ? 1 : 0, v = i >= 2 ? 1 : 0;
        glTexCoord2f(u, v);
        glVertex2f(x + u * 0.38F, y + v * 0.45F);
    }
    glEnd();
    glFinish();
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    const auto window = openEglWindow({}, options.width, options.height);
    window->makeCurrent();
    display = eglGetCurrentDisplay();
    find(createReusable, "eglCreateSyncKHR");
    find(waitReusable, "eglClientWaitSyncKHR");
    find(signalReusable, "eglSignalSyncKHR");
    find(destroyReusable, "eglDestroySyncKHR");
    makePainter();
    window->makeCurrent();
    void (*intoTexture)(GLenum, GLeglImageOES) = nullptr;
    find(intoTexture, "glEGLImageTargetTexture2DOES");
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    intoTexture(GL_TEXTURE_2D, image);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glEnable(GL_TEXTURE_2D);
    taken = createReusable(display, EGL_SYNC_REUSABLE_KHR, nullptr);
    signalReusable(display, taken, EGL_SIGNALED_KHR);
    std::thread other(runPainter, unsigned(options.frames * kRounds));
    for (int frame = 0; frame < options.frames; ++frame) {
        glClearColor(0.1F, 0.1F, 0.3F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (int round = 0; round < kRounds; ++round) {
            const EGLSync sync = takePainted();
            if (eglClientWaitSync(display, sync, EGL_SYNC_FLUSH_COMMANDS_BIT, kPatienceNs) != EGL_CONDITION_SATISFIED) {
                fail("a picture was not painted in time");
            }
            eglDestroySync(display, sync);
            drawImage(round % 5, round / 5);
            signalReusable(display, taken, EGL_SIGNALED_KHR);
        }
        checkNoError("in the drawing thread");
        window->swap();
    }
    other.join();
    destroyReusable(display, taken);
    return 0;
}
