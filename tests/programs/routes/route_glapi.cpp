// A window by GLX, drawn into by another way: Mesa's inner dispatch, which the libGL of before GLVND
// used. Says at the end whether the window shows the picture.
#include <X11/Xutil.h>
#include <cstdio>
#include <dlfcn.h>

#include "tests/programs/routes/glx_functions.hpp"

namespace {

programs::GlFunction findGlx(const char* name) {
    static void* library = dlopen("libGL.so.1", RTLD_NOW);
    return reinterpret_cast<programs::GlFunction>(dlsym(library, name));
}

programs::GlFunction findGl(const char* name) {
    static void* dispatch = dlopen("libglapi.so.0", RTLD_NOW);
    static auto* lookUp = reinterpret_cast<programs::GlFunction (*)(const char*)>(dlsym(dispatch, "_glapi_get_proc_address"));
    return lookUp(name);
}

// The scene's frames are told apart from an empty window by their many colours.
int coloursOf(Display* display, ::Window window, int width) {
    XImage* image = XGetImage(display, window, 0, 60, static_cast<unsigned>(width), 1, AllPlanes, ZPixmap);
    int changes = 0;
    for (int x = 1; image != nullptr && x < width; ++x) {
        changes += XGetPixel(image, x, 0) != XGetPixel(image, x - 1, 0);
    }
    if (image != nullptr) {
        XDestroyImage(image);
    }
    return changes;
}

void sayWhatIsSeen(Display* display, ::Window window, int width) {
    XSync(display, False);
    std::printf("the window shows %s\n", coloursOf(display, window, width) > 5 ? "the picture" : "nothing");
}

} // namespace

int main(int argc, char** argv) {
    return programs::runSceneByGlx(programs::parseOptions(argc, argv), findGlx, findGl, sayWhatIsSeen);
}
