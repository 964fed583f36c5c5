// A libGL.so.1 without a GL of its own: it forwards every call to the system's libGL, which is GLVND's, like some
// switching and measuring layers. Its calls could reach an encoder in two ways.
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
