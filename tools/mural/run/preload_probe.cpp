// Checks in a child process of `mural doctor` that the capture library is preloaded (commands.hpp).
#include <dlfcn.h>
#include <string>

#include "nodes/launch/environment.hpp"
#include "tools/mural/commands.hpp"

namespace mural::cli {

// Searches GLVND's entry into a vendor library, which no other loaded library exports.
int preloadProbeCommand() {
    void* found = dlsym(RTLD_DEFAULT, "__glx_Main");
    Dl_info info{};
    if (found == nullptr || dladdr(found, &info) == 0 || info.dli_fname == nullptr) return 1;
    return std::string(info.dli_fname).ends_with(launch::kCaptureLibraryName) ? 0 : 1;
}

} // namespace mural::cli
