// A window by EGL with desktop OpenGL, all of whose functions come from eglGetProcAddress.
#include <EGL/egl.h>

#include "tests/programs/routes/scene.hpp"
#include "tests/programs/support/program.hpp"

namespace {

programs::GlFunction find(const char* name) { return eglGetProcAddress(name); }

} // namespace

int main(int argc, char** argv) {
    const programs::Options options = programs::parseOptions(argc, argv);
    const auto window = programs::openEglWindow({}, options.width, options.height);
    window->makeCurrent();
    {
        programs::Scene scene(find);
        for (int frame = 0; frame < options.frames; ++frame) {
            scene.draw(frame, options.width, options.height);
            window->swap();
        }
    }
    window->release();
    return 0;
}
