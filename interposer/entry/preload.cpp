// The interface for the preloaded library (interposer/preload). That library has detected that a program's GL library
// does not use GLVND, and exports the same names before it.
#include "interposer/preload/link.hpp"

#include <cstring>

#include "interposer/diagnostics/bypass.hpp"
#include "interposer/entry/wrapped_library.hpp"
#include "interposer/entry/loaded_gl.hpp"

using namespace mural;

extern "C" __attribute__((visibility("default"))) Entry mural_preload_entry(const char* name, Loader library) {
    if (!claimProgram(EntryKind::Preload)) {
        static bool reported = false;
        const char* own = loadedOwnGl();
        if (own && !__atomic_exchange_n(&reported, true, __ATOMIC_RELAXED))
            reportBypass("the program uses two GL libraries; only GLVND's is captured, and drawings of %s stay in the "
                         "program's own window",
                         own);
        return nullptr;
    }
    // Needs no lock: all callers pass the same loader.
    if (!glxLibrary().attached()) glxLibrary().attach(library);
    if (!eglLibrary().attached()) eglLibrary().attach(library);
    return (std::strncmp(name, "egl", 3) ? glxLibrary() : eglLibrary()).replacementFor(name);
}
