#include "nodes/gl/dynamic_library.hpp"

#include <dlfcn.h>

namespace mural::gl {

Result<DynamicLibrary> DynamicLibrary::open(const std::vector<std::string>& names, const std::string& package) {
    std::string reason;
    for (const std::string& name : names) {
        if (void* handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE))
            return DynamicLibrary(handle, name);
        const char* message = dlerror();
        if (reason.empty()) reason = message ? message : "the loader gave no reason";
    }
    return Error{"cannot load " + names.front() + " (" + reason + "): install the package " + package};
}

void* DynamicLibrary::symbol(const char* name) const { return dlsym(handle_, name); }

} // namespace mural::gl
