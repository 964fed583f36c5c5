// Mesa's dispatch of GL names, as Mesa's own libGL used it before GLVND.
#pragma once

#include <cstdlib>
#include <dlfcn.h>

#include "interposer/preload/thunks.hpp"

namespace mural {

using GlLookup = Entry(const char*);

inline GlLookup* findGl() {
    void* dispatch = dlopen("libglapi.so.0", RTLD_NOW);
    auto* lookup = dispatch ? reinterpret_cast<GlLookup*>(dlsym(dispatch, "_glapi_get_proc_address")) : nullptr;
    if (!lookup) std::abort();
    return lookup;
}

// Target of names without an implementation.
inline void nothing() {}

} // namespace mural
