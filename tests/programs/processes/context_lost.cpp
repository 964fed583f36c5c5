// Queries after each frame whether its context is lost, prints the status with the error that follows, and draws on.
// Prints "frame N" after each frame. With --unasked as the last argument its context has no reset notification.
#include "tests/programs/support/gl.hpp"

#include <GL/glx.h>
#include <GL/glxext.h>
#include <cstdio>
#include <cstring>
#include <unistd.h>

#include "tests/programs/support/glx_choice.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/x_window.hpp"

using namespace programs;

namespace {

GLXContext makeRobustContext(Display* display, GLXFBConfig config, bool requestsNotification) {
    const auto create = reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(
        glXGetProcAddress(reinterpret_cast<const GLubyte*>("glXCreateContextAttribsARB")));
    const int attributes[] = {
        GLX_CONTEXT_FLAGS_ARB, GLX_CONTEXT_ROBUST_ACCESS_BIT_ARB, GLX_CONTEXT_RESET_NOTIFICATION_STRATEGY_ARB,
        requestsNotification ? GLX_LOSE_CONTEXT_ON_RESET_ARB : GLX_NO_RESET_NOTIFICATION_ARB, None};
    const GLXContext made = create(display, config, nullptr, True, attributes);
    if (made == nullptr) {
        fail("no context with robust access");
    }
    return made;
}

} // namespace

int main(int argc, char** argv) {
    const bool requestsNotification = std::strcmp(argv[argc - 1], "--unasked") != 0;
    const Options options = parseOptions(requestsNotification ? argc : argc - 1, argv);
    Display* display = openDisplayOnce();
    const GLXFBConfig config = chooseGlxConfig(display, GLX_WINDOW_BIT);
    const XWindow window(*glXGetVisualFromFBConfig(display, config), 0, 0, options.width, options.height);
    if (glXMakeCurrent(display, window.id(), makeRobustContext(display, config, requestsNotification)) != True) {
        fail("glXMakeCurrent failed");
    }
    for (int frame = 0; frame < options.frames; ++frame) {
        glClearColor(0.1F, 0.1F, 0.05F * float(frame % 12), 1);
        glClear(GL_COLOR_BUFFER_BIT);
        glRectf(-0.5F, -0.5F, 0.5F, 0.5F);
        const GLenum status = glGetGraphicsResetStatus();
        const GLenum error = glGetError();
        if (status != GL_NO_ERROR || error != GL_NO_ERROR) {
            std::printf("lost by status 0x%04x, error 0x%04x behind it\n", status, error);
        }
        glXSwapBuffers(display, window.id());
        std::printf("frame %d\n", frame);
        std::fflush(stdout);
        usleep(2000);
    }
    return 0;
}
