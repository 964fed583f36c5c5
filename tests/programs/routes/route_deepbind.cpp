// dlopen with RTLD_DEEPBIND: the library's own names take precedence over preloaded ones.
#include <dlfcn.h>

#include "tests/programs/routes/glx_functions.hpp"

namespace {

void* library;

programs::GlFunction find(const char* name) { return reinterpret_cast<programs::GlFunction>(dlsym(library, name)); }

} // namespace

int main(int argc, char** argv) {
    const programs::Options options = programs::parseOptions(argc, argv);
    library = dlopen("libGL.so.1", RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
    if (library == nullptr) {
        programs::fail("no libGL.so.1: %s", dlerror());
    }
    return programs::runSceneByGlx(options, find, find);
}
