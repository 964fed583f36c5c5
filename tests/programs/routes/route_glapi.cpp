// A window through GLX, drawn into in another way: through Mesa's inner dispatch, which libGL used before GLVND. At the
// end it prints whether the window shows the picture.
#include <cstdio>
#include <dlfcn.h>

#include "tests/programs/routes/glx_functions.hpp"
#include "tests/programs/routes/row_changes.hpp"

namespace {

programs::GlFunction findGlx(const char* name) {
    static void* library = dlopen("libGL.so.1", RTLD_NOW);
    return reinterpret_cast<programs::GlFunction>(dlsym(library, name));
}

programs::GlFunction findGl(const char* name) {
    static void* dispatch = dlopen("libglapi.so.0", RTLD_NOW);
    static auto* lookUp =
        reinterpret_cast<programs::GlFunction (*)(const char*)>(dlsym(dispatch, "_glapi_get_proc_address"));
    return lookUp(name);
}

void printVisiblePixels(Display* display, ::Window window, int width) {
    XSync(display, False);
    std::printf("the window shows %s\n",
                programs::changesInRow(display, window, 60, width) > 5 ? "the picture" : "nothing");
}

} // namespace

int main(int argc, char** argv) {
    return programs::runSceneByGlx(programs::parseOptions(argc, argv), findGlx, findGl, printVisiblePixels);
}
