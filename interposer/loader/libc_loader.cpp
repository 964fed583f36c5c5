#include "interposer/loader/libc_loader.hpp"

#include <cstring>
#include <initializer_list>

#include "interposer/loader/loaded_object.hpp"

namespace mural::loader {

namespace {

// Returns a function of the C library, searched once. Falls back to `linked`, the loader's own binding of the name, if
// no C library with a known name exists.
template <class F> F* cached(F*& known, const char* name, F* linked) {
    if (F* found = __atomic_load_n(&known, __ATOMIC_RELAXED)) return found;
    auto* found = reinterpret_cast<F*>(libcFunction(name));
    if (!found) found = linked;
    __atomic_store_n(&known, found, __ATOMIC_RELAXED);
    return found;
}

} // namespace

void* libcFunction(const char* name) {
    void* found = nullptr;
    for (const char* library : {"libc.so.6", "libdl.so.2"}) { // two libraries before glibc 2.34
        findObject([&](const LoadedObject& object) {
            const char* soname = object.soname();
            if (!soname || std::strcmp(soname, library)) return false;
            found = object.function(name);
            return true;
        });
        if (found) return found;
    }
    return nullptr;
}

void* nextFunction(const char* name) {
    void* found = nullptr;
    bool isBehind = false;
    findObject([&](const LoadedObject& object) {
        if (isBehind) found = object.function(name);
        isBehind = isBehind || object.contains(reinterpret_cast<const void*>(&nextFunction));
        return found != nullptr;
    });
    return found;
}

// These three functions store the result before they return it, which prevents a tail call. The C library examines its
// caller for RTLD_NEXT and for the search path. After a tail call it would see our caller.

void* openLibrary(const char* name, int flags) {
    static decltype(&::dlopen) known = nullptr;
    void* volatile handle = cached(known, "dlopen", &::dlopen)(name, flags);
    return handle;
}

void closeLibrary(void* handle) {
    static decltype(&::dlclose) known = nullptr;
    cached(known, "dlclose", &::dlclose)(handle);
}

void* symbolIn(void* handle, const char* name) {
    static decltype(&::dlsym) known = nullptr;
    void* volatile found = cached(known, "dlsym", &::dlsym)(handle, name);
    return found;
}

void keepLoaded(const void* address) {
    char path[4096] = {};
    findObject([&](const LoadedObject& object) {
        if (!object.contains(address)) return false;
        if (std::strlen(object.path()) < sizeof path) std::strcpy(path, object.path());
        return true;
    });
    if (!path[0]) return; // the program itself
    if (void* handle = openLibrary(path, RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE)) closeLibrary(handle);
}

} // namespace mural::loader
