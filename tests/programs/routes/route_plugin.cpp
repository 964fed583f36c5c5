// Opens its window in the program and draws from a plug-in, loaded without making its names global.
#include <dlfcn.h>
#include <string>

#include "tests/programs/support/program.hpp"

int main(int argc, char** argv) {
    const programs::Options options = programs::parseOptions(argc, argv);
    std::string path = argv[0];
    path.resize(path.find_last_of('/') + 1);
    path += "plugin.so";
    void* plugin = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (plugin == nullptr) {
        programs::fail("no plug-in: %s", dlerror());
    }
    const auto draw = reinterpret_cast<void (*)(int, int, int)>(dlsym(plugin, "drawByPlugin"));
    const auto window = programs::openGlxWindow({}, options.width, options.height);
    window->makeCurrent();
    for (int frame = 0; frame < options.frames; ++frame) {
        draw(frame, options.width, options.height);
        programs::checkNoError("in the plug-in's frame");
        window->swap();
    }
    window->release();
    return 0;
}
