// The preloaded entry (libmural_preload.so). It exports all names of GL, GLX and EGL before a GL library that does not
// use GLVND. Its functions jump to the wrappers of libGLX_mural.so.0, which the vendor entry returns as well. `mural
// run` preloads it only into programs with such a library. If GLVND's libraries are loaded as well, calls of their
// names are passed on, because they arrive through the vendor entry.
#include <initializer_list>

#include "interposer/loader/libc_loader.hpp"
#include "interposer/preload/gl_objects.hpp"
#include "interposer/preload/link.hpp"
#include "interposer/preload/next_symbol.hpp"
#include "interposer/preload/thunks.hpp"

namespace mural {

namespace {

// The function for a name that no library exports. It returns null, like a failed lookup.
void* nothing() { return nullptr; }

// Returns the function that the program would have found without us. Libraries that were opened without global names
// are not in the search order, so they are queried by name.
Entry nextEntry(const char* name) {
    if (void* found = loader::symbolIn(RTLD_NEXT, name)) return reinterpret_cast<Entry>(found);
    for (const char* library : {"libGL.so.1", "libEGL.so.1", "libGLESv2.so.2", "libGLESv1_CM.so.1"}) {
        void* handle = loader::openLibrary(library, RTLD_LAZY | RTLD_NOLOAD);
        if (!handle) continue;
        void* found = loader::symbolIn(handle, name);
        loader::closeLibrary(handle);
        if (found && !isFromMural(found)) return reinterpret_cast<Entry>(found);
    }
    return nullptr;
}

bool isOwnGl(Entry entry) { return objectOf(reinterpret_cast<const void*>(entry)) == GlObject::Own; }

// Returns functions of the wrapped library for the encoder: exported ones, or results of the library's own lookup.
Entry nextAfterMural(const char* name) {
    const Entry exported = nextEntry(name);
    if (exported && isOwnGl(exported)) return exported;
    using Lookup = Entry(const char*);
    for (const char* lookup : {"glXGetProcAddressARB", "eglGetProcAddress"}) {
        const Entry lookupFunction = nextEntry(lookup);
        if (!lookupFunction || !isOwnGl(lookupFunction)) continue;
        if (const Entry found = reinterpret_cast<Lookup*>(lookupFunction)(name)) return found;
    }
    return nullptr;
}

// Returns the target of a program's call of `name`, for which the wrapped library has `next`.
Entry entryOf(const char* name, Entry next) {
    if (!isOwnGl(next)) return next;
    const Entry replacement = mural_preload_entry(name, nextAfterMural);
    return replacement ? replacement : next;
}

int thunkOf(const char* name) {
    int low = 0, high = thunkCount() - 1;
    while (low <= high) {
        const int middle = (low + high) / 2;
        const int order = __builtin_strcmp(name, thunkName(middle));
        if (order == 0) return middle;
        if (order < 0)
            high = middle - 1;
        else
            low = middle + 1;
    }
    return -1;
}

} // namespace

Entry resolveSlot(int number) {
    const char* name = thunkName(number);
    const Entry next = nextEntry(name);
    if (!next) return reinterpret_cast<Entry>(nothing);
    const Entry entry = entryOf(name, next);
    loader::keepLoaded(reinterpret_cast<const void*>(next)); // the slot must not outlive the library
    __atomic_store_n(&gSlots[number], entry, __ATOMIC_RELEASE);
    return entry;
}

void* replaceFound(const char* name, void* found) {
    if (thunkOf(name) < 0) return found;
    auto next = reinterpret_cast<Entry>(found);
    if (isFromMural(found)) next = nextEntry(name); // found only because we export it
    return next ? reinterpret_cast<void*>(entryOf(name, next)) : nullptr;
}

} // namespace mural
