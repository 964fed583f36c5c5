// Xlib's functions, from the copy that the program has already loaded. Nothing is linked or loaded.
#pragma once

#include "interposer/loader/libc_loader.hpp"

namespace mural {

// Returns a function of a library that the program has loaded, and keeps that library loaded. Null: not loaded.
template <class F> F* loadedFunction(const char* library, const char* name) {
    void* handle = loader::openLibrary(library, RTLD_LAZY | RTLD_NOLOAD);
    return handle ? reinterpret_cast<F*>(loader::symbolIn(handle, name)) : nullptr;
}

// The same, repeated until the library is loaded. Any thread may use it.
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
    static void* handle = nullptr; // kept, so that the library stays loaded
    if (!handle) handle = loader::openLibrary("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    return handle ? loader::symbolIn(handle, name) : nullptr;
}

// Returns null if the program has no Xlib.
template <class F> F* xlib(const char* name) { return reinterpret_cast<F*>(xlibSymbol(name)); }

} // namespace mural
