// Windows from libGLX, drawing from libOpenGL, both linked, without libGL.
#include <dlfcn.h>

#include "tests/programs/routes/glx_functions.hpp"

namespace {

// Returns functions of linked libraries, as the dynamic linker finds them for the program itself.
programs::GlFunction find(const char* name) {
    return reinterpret_cast<programs::GlFunction>(dlsym(RTLD_DEFAULT, name));
}

} // namespace

int main(int argc, char** argv) {
    const programs::Options options = programs::parseOptions(argc, argv);
    return programs::runSceneByGlx(options, find, find);
}
