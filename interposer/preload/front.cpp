// The preloaded front: exports all names of GL, GLX and EGL in front of a GL library that GLVND does not
// lead to, and jumps to the wrappers of libGLX_mural.so.0, the same that the vendor front gives out.
// `mural run` preloads it only into programs that have such a library. Names of GLVND's libraries, which
// may be there as well, are passed on: their calls arrive by the vendor front.
#include <initializer_list>

#include "interposer/loader/libc_loader.hpp"
#include "interposer/preload/gl_objects.hpp"
#include "interposer/preload/link.hpp"
#include "interposer/preload/next_symbol.hpp"
#include "interposer/preload/thunks.hpp"

namespace mural {

namespace {

// A name that no library has: as a program would find it by a lookup that may fail.
void* nothing() { return nullptr; }

// The function that the program would have found without us. Libraries that were opened without making
// their names global are not behind us in the order, so they are asked by name.
Entry nextEntry(const char* name) {
    if (void* found = loader::symbolIn(RTLD_NEXT, name)) return reinterpret_cast<Entry>(found);
    for (const char* library : {"libGL.so.1", "libEGL.so.1", "libGLESv2.so.2", "libGLESv1_CM.so.1"}) {
        void* handle = loader::openLibrary(library, RTLD_LAZY | RTLD_NOLOAD);
        if (!handle) continue;
        void* found = loader::symbolIn(handle, name);
        loader::closeLibrary(handle);
        if (found && !isOurs(found)) return reinterpret_cast<Entry>(found);
    }
    return nullptr;
}

bool isOwnGl(Entry entry) { return objectOf(reinterpret_cast<const void*>(entry)) == GlObject::Own; }

// Functions of the library behind, for the encoder: exported, or found by the library's own lookup.
Entry behindUs(const char* name) {
    const Entry exported = nextEntry(name);
    if (exported && isOwnGl(exported)) return exported;
    using Lookup = Entry(const char*);
    for (const char* lookup : {"glXGetProcAddressARB", "eglGetProcAddress"}) {
        const Entry ask = nextEntry(lookup);
        if (!ask || !isOwnGl(ask)) continue;
        if (const Entry found = reinterpret_cast<Lookup*>(ask)(name)) return found;
    }
    return nullptr;
}

// What a program's call of `name` leads to, when the library behind has `next` for it.
Entry frontOf(const char* name, Entry next) {
    if (!isOwnGl(next)) return next;
    const Entry ours = mural_front_entry(name, behindUs);
    return ours ? ours : next;
}

int thunkOf(const char* name) {
    int low = 0, high = thunkCount() - 1;
    while (low <= high) {
        const int middle = (low + high) / 2;
        const int order = __builtin_strcmp(name, thunkName(middle));
        if (order == 0) return middle;
        if (order < 0) high = middle - 1;
        else low = middle + 1;
    }
    return -1;
}

} // namespace

Entry resolveSlot(int number) {
    const char* name = thunkName(number);
    const Entry next = nextEntry(name);
    if (!next) return reinterpret_cast<Entry>(nothing);
    const Entry entry = frontOf(name, next);
    loader::keepLoaded(reinterpret_cast<const void*>(next)); // the slot outlives an unloading
    __atomic_store_n(&gSlots[number], entry, __ATOMIC_RELEASE);
    return entry;
}

void* replaceFound(const char* name, void* found) {
    if (thunkOf(name) < 0) return found;
    auto next = reinterpret_cast<Entry>(found);
    if (isOurs(found)) next = nextEntry(name); // there only because we are
    return next ? reinterpret_cast<void*>(frontOf(name, next)) : nullptr;
}

} // namespace mural
