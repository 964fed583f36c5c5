// Xlib's functions, from the copy that the program already has; nothing is linked, nothing is loaded.
#pragma once

#include <dlfcn.h>

namespace mural {

// Of a library that the program has loaded; null: it has not.
template <class F> F* loadedFunction(const char* library, const char* name) {
    void* handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
    F* function = handle ? reinterpret_cast<F*>(dlsym(handle, name)) : nullptr;
    if (handle) dlclose(handle);
    return function;
}

inline void* xlibSymbol(const char* name) {
    static void* handle = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    return handle ? dlsym(handle, name) : nullptr;
}

// Null when the program has no Xlib.
template <class F> F* xlib(const char* name) { return reinterpret_cast<F*>(xlibSymbol(name)); }

} // namespace mural
