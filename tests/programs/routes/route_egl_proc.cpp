// A window through EGL with desktop OpenGL, all of whose functions come from eglGetProcAddress.
#include <EGL/egl.h>

#include "tests/programs/routes/egl_scene.hpp"

namespace {

programs::GlFunction find(const char* name) { return eglGetProcAddress(name); }

} // namespace

int main(int argc, char** argv) {
    return programs::runSceneByEgl(programs::parseOptions(argc, argv), find, [] {});
}
