// Drawing of an unflushed context as a second thread sees it:
//   - while the context is current;
//   - after its thread has released it (KHR_context_flush_control: flushed then, or not);
//   - after a flush.
// The threads run in step, and the observed colours are shown as numbers. The target is a texture, because framebuffer
// objects are not shared.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/glx_choice.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <GL/glx.h>
#include <GL/glxext.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "tests/programs/support/x_window.hpp"

using namespace programs;

namespace {

Display* display;
GLXFBConfig config;

enum Release { Unsaid, Flush, Keep };

GLXContext makeContext(GLXContext share, Release release) {
    static const auto create = reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(
        glXGetProcAddress(reinterpret_cast<const GLubyte*>("glXCreateContextAttribsARB")));
    const int attributes[] = {GLX_CONTEXT_MAJOR_VERSION_ARB,
                              3,
                              GLX_CONTEXT_MINOR_VERSION_ARB,
                              3,
                              GLX_CONTEXT_PROFILE_MASK_ARB,
                              GLX_CONTEXT_CORE_PROFILE_BIT_ARB,
                              release == Unsaid ? 0 : GLX_CONTEXT_RELEASE_BEHAVIOR_ARB,
                              release == Keep ? GLX_CONTEXT_RELEASE_BEHAVIOR_NONE_ARB
                                              : GLX_CONTEXT_RELEASE_BEHAVIOR_FLUSH_ARB,
                              None};
    const GLXContext made = create(display, config, share, True, attributes);
    if (made == nullptr) {
        fail("no core context whose release behaviour can be chosen");
    }
    return made;
}

void use(GLXDrawable drawable, GLXContext context) {
    if (glXMakeCurrent(display, drawable, context) != True) {
        fail("glXMakeCurrent failed");
    }
}

// A thread that executes a function while the caller waits.
class Worker {
public:
    Worker() : thread_([this] { run(); }) {}
    ~Worker() {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            ends_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
    void operator()(const std::function<void()>& work) {
        std::unique_lock<std::mutex> lock(mutex_);
        work_ = &work;
        changed_.notify_all();
        changed_.wait(lock, [&] { return work_ == nullptr; });
    }

private:
    void run() {
        std::unique_lock<std::mutex> lock(mutex_);
        for (;;) {
            changed_.wait(lock, [&] { return ends_ || work_ != nullptr; });
            if (ends_) {
                return;
            }
            (*work_)();
            work_ = nullptr;
            changed_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    const std::function<void()>* work_ = nullptr;
    bool ends_ = false;
    std::thread thread_;
};

// Makes the texture the target of the current context.
void drawTo(GLuint texture) {
    GLuint target = 0;
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

void clearWith(float red, float green) {
    glClearColor(red, green, 0.25F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

std::uint32_t seen() {
    std::uint32_t pixel = 0;
    glReadPixels(1, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &pixel);
    return pixel;
}

// Observations of the other thread, step by step.
struct Observations {
    std::uint32_t held = 0, givenUp = 0, taken = 0, flushed = 0;
    GLint behavior = 0;
};

Observations observe(GLXDrawable window, GLXContext drawer, GLXContext other, GLXDrawable otherWindow,
                     GLXContext watcher, bool toNone) {
    Observations observed;
    use(window, drawer);
    glGetIntegerv(GL_CONTEXT_RELEASE_BEHAVIOR, &observed.behavior);
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    drawTo(texture);
    clearWith(0, 1);
    glFinish();
    clearWith(1, 0); // not flushed
    Worker worker;
    worker([&] {
        use(otherWindow, watcher);
        drawTo(texture);
        observed.held = seen();
    });
    toNone ? use(None, nullptr) : use(window, other);
    worker([&] { observed.givenUp = seen(); });
    use(window, drawer);
    worker([&] { observed.taken = seen(); });
    glFinish();
    worker([&] {
        observed.flushed = seen();
        checkNoError("in the thread that looks");
        use(None, nullptr);
    });
    checkNoError("in the thread that draws");
    return observed;
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    display = openDisplayOnce();
    config = chooseGlxConfig(display, GLX_WINDOW_BIT);
    XVisualInfo* visual = glXGetVisualFromFBConfig(display, config);
    const XWindow window(*visual, 0, 0, options.width, options.height);
    const XWindow otherWindow(*visual, options.width, 0, 16, 16);
    const GLXContext shown = makeContext(nullptr, Unsaid);
    for (int frame = 0; frame < options.frames; ++frame) {
        use(window.id(), shown);
        glClearColor(0.1F, 0.2F, 0.2F, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        int row = 0;
        for (const Release release : {Keep, Flush, Unsaid}) {
            for (const bool toNone : {false, true}) {
                const GLXContext drawer = makeContext(shown, release), other = makeContext(shown, Flush),
                                 watcher = makeContext(shown, Unsaid);
                const Observations observed = observe(window.id(), drawer, other, otherWindow.id(), watcher, toNone);
                use(window.id(), shown);
                for (const std::uint32_t value : {observed.held, observed.givenUp, observed.taken, observed.flushed,
                                                  std::uint32_t(observed.behavior)}) {
                    showBits(row++, value);
                }
                for (const GLXContext context : {drawer, other, watcher}) {
                    glXDestroyContext(display, context);
                }
            }
        }
        checkNoError("in the window's context");
        glXSwapBuffers(display, window.id());
    }
    return 0;
}
