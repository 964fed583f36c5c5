// Loads, uses and unloads GL libraries several times, as toolkits do that end and begin again. The second argument
// changes the environment before:
//   gl_reloaded glx|egl|both untouched|cleared|unset|put|other
#include <cstdio>
#include <cstdlib>
#include <string>
#include <unistd.h>

#include "tests/programs/loading/drawing_round.hpp"
#include "tests/programs/support/program.hpp"

namespace {

constexpr const char* kNames[] = {"LD_PRELOAD", "LD_LIBRARY_PATH", "__GLX_VENDOR_LIBRARY_NAME",
                                  "__EGL_VENDOR_LIBRARY_FILENAMES"};

void changeEnvironment(const std::string& how, int round) {
    static char put[] = "__GLX_VENDOR_LIBRARY_NAME=mesa";
    if (how == "cleared") {
        clearenv();
    } else if (how == "unset" && round == 1) { // between two rounds
        for (const char* name : kNames) unsetenv(name);
    } else if (how == "put") {
        putenv(put);
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/usr/share/glvnd/egl_vendor.d/50_mesa.json", 1);
    } else if (how == "other") { // by hand
        static char* none[] = {nullptr};
        environ = none;
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 3) programs::fail("two arguments are needed");
    const std::string systems = argv[1], how = argv[2],
                      display = std::getenv("DISPLAY") != nullptr ? std::getenv("DISPLAY") : "";
    for (int round = 0; round < 3; ++round) {
        changeEnvironment(how, round);
        const char* vendor = std::getenv("__GLX_VENDOR_LIBRARY_NAME");
        if (how != "untouched" && (how != "unset" || round > 0))
            std::printf("the program sees vendor %s\n", vendor != nullptr ? vendor : "none");
        if (systems != "egl") programs::drawRound({programs::WindowSystem::Glx, round, 3, display});
        if (systems != "glx") programs::drawRound({programs::WindowSystem::Egl, round, 3, display});
    }
    return 0;
}
