// Xlib's functions, from the copy that the program already has; nothing is linked, nothing is loaded.
#pragma once

#include "interposer/loader/libc_loader.hpp"

namespace mural {

inline void* xlibSymbol(const char* name) {
    static void* handle = nullptr; // kept: the library stays
    if (!handle) handle = loader::openLibrary("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    return handle ? loader::symbolIn(handle, name) : nullptr;
}

// Null when the program has no Xlib.
template <class F> F* xlib(const char* name) { return reinterpret_cast<F*>(xlibSymbol(name)); }

} // namespace mural
