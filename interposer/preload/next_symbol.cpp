#include "interposer/preload/next_symbol.hpp"

#include "interposer/loader/libc_loader.hpp"

namespace mural {

namespace {

using Dlsym = void*(void*, const char*);
Dlsym* nextDlsym = nullptr;

// Returns the dlsym of the next library in load order, or the C library's. Does not use dlvsym, which may be replaced
// as well.
Dlsym* findDlsym() {
    Dlsym* next = __atomic_load_n(&nextDlsym, __ATOMIC_RELAXED);
    if (next) return next;
    next = reinterpret_cast<Dlsym*>(loader::nextFunction("dlsym"));
    __atomic_store_n(&nextDlsym, next, __ATOMIC_RELAXED);
    return next;
}

bool maybeGl(const char* name) {
    return name && ((name[0] == 'g' && name[1] == 'l') || (name[0] == 'e' && name[1] == 'g' && name[2] == 'l'));
}

} // namespace

} // namespace mural

extern "C" __attribute__((visibility("default"))) void* dlsym(void* handle, const char* name) noexcept {
    using namespace mural;
    // This is a tail call, because this file is always built with -foptimize-sibling-calls. libc must see our caller:
    // RTLD_NEXT and RTLD_DEFAULT depend on the caller's place in the load order.
    if (!maybeGl(name) || handle == RTLD_NEXT) {
        Dlsym* next = findDlsym();
        if (!next) return nullptr;
        return next(handle, name);
    }
    // Stores the result first, because a tail call would make libc see our caller instead of us.
    Dlsym* next = findDlsym();
    void* volatile found = next ? next(handle, name) : nullptr;
    return found ? replaceFound(name, found) : nullptr;
}
