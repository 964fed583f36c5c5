// A libGL.so.1 that is no GL of its own: it hands every call to the system's libGL, which is GLVND's, as
// some switching and measuring layers do. Its calls would reach an encoder on two ways.
#include <cstdlib>
#include <dlfcn.h>

#include "interposer/preload/thunks.hpp"

namespace mural {

namespace {
void nothing() {}
} // namespace

Entry resolveSlot(int number) {
    static void* system = dlopen(MURAL_SYSTEM_LIBGL, RTLD_NOW | RTLD_LOCAL);
    if (!system) std::abort();
    const auto found = reinterpret_cast<Entry>(dlsym(system, thunkName(number)));
    if (!found) return nothing;
    __atomic_store_n(&gSlots[number], found, __ATOMIC_RELEASE);
    return found;
}

} // namespace mural
