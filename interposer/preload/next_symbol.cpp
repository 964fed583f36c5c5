#include "interposer/preload/next_symbol.hpp"

#include "interposer/loader/libc_loader.hpp"

namespace mural {

namespace {

using Dlsym = void*(void*, const char*);
Dlsym* nextDlsym = nullptr;

// Another library's that stands behind this one, else the C library's. Not found by dlvsym, which may be replaced as well.
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
    // A jump (this file is always built with -foptimize-sibling-calls): libc has to see our caller, whose
    // place in the order RTLD_NEXT and RTLD_DEFAULT go by.
    if (!maybeGl(name) || handle == RTLD_NEXT) {
        Dlsym* next = findDlsym();
        if (!next) return nullptr;
        return next(handle, name);
    }
    // Stored before it is used: a tail call would hide our caller from libc.
    Dlsym* next = findDlsym();
    void* volatile found = next ? next(handle, name) : nullptr;
    return found ? replaceFound(name, found) : nullptr;
}
