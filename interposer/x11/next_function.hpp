// Calls the next function of a replaced X request, in the program's own load order. Never loads a library.
#pragma once

#include "interposer/loader/libc_loader.hpp"

namespace mural {

constexpr const char* kXlib = "libX11.so.6";
constexpr const char* kXext = "libXext.so.6";
constexpr const char* kXcb = "libxcb.so.1";
constexpr const char* kXcbShm = "libxcb-shm.so.0";

struct NextFunction {
    const char* name;
    const char* library;
    void* found = nullptr;

    void* get() {
        if (void* known = __atomic_load_n(&found, __ATOMIC_RELAXED)) return known;
        void* next = loader::symbolIn(RTLD_NEXT, name);
        if (!next) { // the program has loaded the library without global names
            void* handle = loader::openLibrary(library, RTLD_LAZY | RTLD_NOLOAD);
            if (handle) next = loader::symbolIn(handle, name);
            if (handle) loader::closeLibrary(handle);
        }
        if (next) loader::keepLoaded(next); // a plugin with its own library may be unloaded and loaded elsewhere
        __atomic_store_n(&found, next, __ATOMIC_RELAXED);
        return next;
    }
};

// The result of a request without the library in this process.
template <class Result> struct Nothing {
    static Result value() { return Result{}; }
};
template <> struct Nothing<void> {
    static void value() {}
};

// `like` is the replacing function itself. It has the type of the next function.
template <class Result, class... Parameters, class... Arguments>
Result callNext(NextFunction& next, Result (*like)(Parameters...), Arguments... arguments) {
    (void)like;
    auto* call = reinterpret_cast<Result (*)(Parameters...)>(next.get());
    return call ? call(arguments...) : Nothing<Result>::value();
}

// The same with the type of the function only, so that the linker sees no reference to it.
template <class Function> struct CallOf;
template <class Result, class... Parameters> struct CallOf<Result(Parameters...)> {
    static Result call(NextFunction& next, Parameters... arguments) {
        auto* call = reinterpret_cast<Result (*)(Parameters...)>(next.get());
        return call ? call(arguments...) : Nothing<Result>::value();
    }
};

} // namespace mural

#define MURAL_CALL_OF(next, function, ...) (::mural::CallOf<decltype(function)>::call(next, __VA_ARGS__))
#define MURAL_SHOWN extern "C" __attribute__((visibility("default")))
