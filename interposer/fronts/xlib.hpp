// Xlib's functions, from the copy that the program already has; nothing is linked, nothing is loaded.
#pragma once

#include "interposer/loader/libc_loader.hpp"

namespace mural {

// A function of a library that the program has loaded, which stays loaded from then on; null: not loaded.
template <class F> F* loadedFunction(const char* library, const char* name) {
    void* handle = loader::openLibrary(library, RTLD_LAZY | RTLD_NOLOAD);
    return handle ? reinterpret_cast<F*>(loader::symbolIn(handle, name)) : nullptr;
}

// The same, looked up until the library is there. Any thread.
template <class F> struct Loaded {
    const char* library;
    const char* name;
    F* found = nullptr;

    F* get() {
        if (F* earlier = __atomic_load_n(&found, __ATOMIC_RELAXED)) return earlier;
        F* function = loadedFunction<F>(library, name);
        __atomic_store_n(&found, function, __ATOMIC_RELAXED);
        return function;
    }
};

inline void* xlibSymbol(const char* name) {
    static void* handle = nullptr; // kept: the library stays
    if (!handle) handle = loader::openLibrary("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    return handle ? loader::symbolIn(handle, name) : nullptr;
}

// Null when the program has no Xlib.
template <class F> F* xlib(const char* name) { return reinterpret_cast<F*>(xlibSymbol(name)); }

} // namespace mural
