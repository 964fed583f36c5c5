// A libEGL.so.1 with libGLESv2's names, as it was before GLVND: EGL from Mesa's driver, GL through libglapi.
#include <EGL/egl.h>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <glvnd/libeglabi.h>

#include "interposer/preload/thunks.hpp"
#include "tests/programs/own_gl/mesa_dispatch.hpp"

namespace mural {

namespace {

using EglLookup = void*(const char*);

__EGLapiExports exports;
__EGLapiImports imports;

EglLookup* findEgl() {
    void* driver = dlopen("libEGL_mesa.so.0", RTLD_NOW);
    using Main = EGLBoolean(uint32_t, const __EGLapiExports*, __EGLvendorInfo*, __EGLapiImports*);
    auto* main = driver ? reinterpret_cast<Main*>(dlsym(driver, "__egl_Main")) : nullptr;
    if (!main || !main(EGL_VENDOR_ABI_VERSION, &exports, nullptr, &imports)) std::abort();
    return imports.getProcAddress;
}

} // namespace

Entry resolveSlot(int number) {
    static EglLookup* egl = findEgl();
    static GlLookup* gl = findGl();
    const char* name = thunkName(number);
    const Entry found = std::strncmp(name, "egl", 3) == 0 ? reinterpret_cast<Entry>(egl(name)) : gl(name);
    if (!found) return nothing;
    __atomic_store_n(&gSlots[number], found, __ATOMIC_RELEASE);
    return found;
}

} // namespace mural
