// A libGL.so.1 as it was before GLVND: it exports all names, and calls Mesa's driver itself. GL names pass through
// libglapi, as in Mesa's own libGL. GLX names call the functions of libGLX_mesa.so.0, around GLVND.
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <X11/Xlib.h>
#include <glvnd/libglxabi.h>

#include "interposer/preload/thunks.hpp"
#include "tests/programs/own_gl/mesa_dispatch.hpp"

namespace mural {

namespace {

using GlxLookup = void*(const unsigned char*);

// The exports that libGLX would pass to the vendor. Mesa uses them only in its dispatch functions, which are never
// called here.
__GLXapiExports exports;
__GLXapiImports imports;

GlxLookup* findGlx() {
    void* driver = dlopen("libGLX_mesa.so.0", RTLD_NOW);
    using Main = Bool(uint32_t, const __GLXapiExports*, __GLXvendorInfo*, __GLXapiImports*);
    auto* main = driver ? reinterpret_cast<Main*>(dlsym(driver, "__glx_Main")) : nullptr;
    if (!main || !main(GLX_VENDOR_ABI_VERSION, &exports, nullptr, &imports)) std::abort();
    return imports.getProcAddress;
}

Entry lookUp(const char* name) {
    static GlxLookup* glx = findGlx();
    static GlLookup* gl = findGl();
    const bool isGlx = std::strncmp(name, "glX", 3) == 0;
    return isGlx ? reinterpret_cast<Entry>(glx(reinterpret_cast<const unsigned char*>(name))) : gl(name);
}

} // namespace

Entry resolveSlot(int number) {
    const Entry found = lookUp(thunkName(number));
    if (!found) return nothing;
    __atomic_store_n(&gSlots[number], found, __ATOMIC_RELEASE);
    return found;
}

} // namespace mural
