#include "interposer/preload/next_symbol.hpp"

#include <dlfcn.h>
#include <initializer_list>

namespace mural {

namespace {

using Dlsym = void*(void*, const char*);
Dlsym* libcDlsym = nullptr;

Dlsym* findDlsym() {
    if (Dlsym* known = __atomic_load_n(&libcDlsym, __ATOMIC_RELAXED)) return known;
    // The versions under which glibc has had it, by processor and age.
    for (const char* version : {"GLIBC_2.34", "GLIBC_2.17", "GLIBC_2.2.5"}) {
        void* found = dlvsym(RTLD_NEXT, "dlsym", version);
        if (!found) continue;
        __atomic_store_n(&libcDlsym, reinterpret_cast<Dlsym*>(found), __ATOMIC_RELAXED);
        return reinterpret_cast<Dlsym*>(found);
    }
    return nullptr;
}

bool maybeGl(const char* name) {
    return name && ((name[0] == 'g' && name[1] == 'l') || (name[0] == 'e' && name[1] == 'g' && name[2] == 'l'));
}

} // namespace

void* nextSymbol(void* handle, const char* name) {
    Dlsym* next = findDlsym();
    // Stored and returned: a tail call would make glibc look at our caller's place in the order.
    void* volatile found = next ? next(handle, name) : nullptr;
    return found;
}

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
    void* found = nextSymbol(handle, name);
    return found ? replaceFound(name, found) : nullptr;
}
