#include "nodes/launch/forking/preload_driver.hpp"

#include <dlfcn.h>
#include <string>
#include <unistd.h>

namespace mural {
namespace {

// Returns the folder of a loaded library by one of its functions; empty: unknown.
std::string folderOfSymbol(void* library, const char* symbol) {
    void* const function = dlsym(library, symbol);
    Dl_info found{};
    if (function == nullptr || dladdr(function, &found) == 0 || found.dli_fname == nullptr) return "";
    const std::string path = found.dli_fname;
    const size_t slash = path.rfind('/');
    return slash == std::string::npos ? "" : path.substr(0, slash);
}

} // namespace

void preloadDriver() {
    if (access("/proc/driver/nvidia/version", F_OK) == 0) return;
    constexpr int kMode = RTLD_NOW | RTLD_LOCAL;
    if (dlopen("libEGL.so.1", kMode) == nullptr) return;
    void* const mesa = dlopen("libEGL_mesa.so.0", kMode);
    if (mesa == nullptr) return;
    const std::string folder = folderOfSymbol(mesa, "__egl_Main");
    // Newer releases of Mesa link the drivers into a library of libEGL_mesa.so.0 instead.
    if (!folder.empty()) (void)dlopen((folder + "/dri/swrast_dri.so").c_str(), kMode);
}

} // namespace mural
