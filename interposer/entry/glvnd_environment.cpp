#include "interposer/entry/glvnd_environment.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

#include "common/base/gl_library_names.hpp"
#include "interposer/process/launch_settings.hpp"
#include "interposer/loader/libc_loader.hpp"
#include "interposer/loader/loaded_object.hpp"

namespace mural {

namespace {

constexpr char kGlxVendor[] = "__GLX_VENDOR_LIBRARY_NAME";
constexpr char kGlxScreenVendor[] = "__GLX_FORCE_VENDOR_LIBRARY_"; // followed by the number of a screen
constexpr char kEglVendors[] = "__EGL_VENDOR_LIBRARY_FILENAMES";
constexpr char kOurVendor[] = "mural";
constexpr char kOurEglFile[] = "mural_egl_vendor.json"; // in the folder of this library

using Getenv = char*(const char*);
Getenv* nextGetenv = nullptr;
Getenv* nextSecureGetenv = nullptr;

__attribute__((constructor)) void findNext() {
    nextGetenv = reinterpret_cast<Getenv*>(loader::nextFunction("getenv"));
    nextSecureGetenv = reinterpret_cast<Getenv*>(loader::nextFunction("secure_getenv"));
}

bool isCaptured() { return launchSettings().session || launchSettings().native; }

bool isGlvnd(const void* caller) {
    return loader::findObject([&](const loader::LoadedObject& object) {
        if (!object.contains(caller)) return false;
        const char* name = object.soname();
        return name && (!std::strcmp(name, "libGLX.so.0") || !std::strcmp(name, "libEGL.so.1")) &&
               object.needs(isGlvndDispatch);
    });
}

char* ourEglFile() {
    static char path[4096];
    loader::findObject([](const loader::LoadedObject& object) {
        if (!object.contains(reinterpret_cast<const void*>(&isGlvnd))) return false;
        const char* slash = std::strrchr(object.path(), '/');
        const auto folder = static_cast<int>(slash ? slash + 1 - object.path() : 0);
        snprintf(path, sizeof path, "%.*s%s", folder, object.path(), kOurEglFile);
        return true;
    });
    return path;
}

// Returns whether GLVND queries its vendor. Stores the value for it in `answer`.
bool answersGlvnd(const char* name, const void* caller, char*& answer) {
    if (name[0] != '_' || name[1] != '_' || (std::strncmp(name, "__GLX_", 6) && std::strncmp(name, "__EGL_", 6)))
        return false;
    static char ourVendor[] = "mural";
    if (!std::strcmp(name, kGlxVendor)) answer = ourVendor;
    // the setting for all screens applies
    else if (!std::strncmp(name, kGlxScreenVendor, sizeof kGlxScreenVendor - 1))
        answer = nullptr;
    else if (!std::strcmp(name, kEglVendors))
        answer = ourEglFile();
    else
        return false;
    return isCaptured() && isGlvnd(caller);
}

bool isSet(const char* value) { return value && *value; }

} // namespace

const char* wantedGlxVendor() {
    for (const char* name : {"__GLX_FORCE_VENDOR_LIBRARY_0", kGlxVendor}) {
        const char* own = std::getenv(name);
        if (isSet(own) && std::strcmp(own, kOurVendor)) return own;
    }
    return launchSettings().realGlxVendor;
}

const char* wantedEglVendors() {
    const char* own = std::getenv(kEglVendors);
    if (isSet(own) && !std::strstr(own, kOurEglFile)) return own;
    return launchSettings().realEglVendors;
}

namespace {

// Constructors of other libraries call these functions before the address sanitizer has mapped its shadow memory, which
// instrumented code reads.
#ifdef __SANITIZE_ADDRESS__
extern "C" void __asan_init();
inline void startSanitizer() { __asan_init(); }
#define MURAL_BEFORE_SANITIZER __attribute__((no_sanitize_address))
#else
inline void startSanitizer() {}
#define MURAL_BEFORE_SANITIZER
#endif

__attribute__((noinline)) char* valueFor(const char* name, const void* caller, Getenv*& next) {
    char* answer = nullptr;
    if (answersGlvnd(name, caller, answer)) return answer;
    if (!next) findNext(); // for calls from another library's constructor
    return next ? next(name) : nullptr;
}

} // namespace

} // namespace mural

// Allocators call these functions while they start, so they allocate nothing.
extern "C" __attribute__((visibility("default"))) MURAL_BEFORE_SANITIZER char* getenv(const char* name) noexcept {
    mural::startSanitizer();
    return mural::valueFor(name, __builtin_return_address(0), mural::nextGetenv);
}

extern "C" __attribute__((visibility("default"))) MURAL_BEFORE_SANITIZER char* secure_getenv(
    const char* name) noexcept {
    mural::startSanitizer();
    return mural::valueFor(name, __builtin_return_address(0), mural::nextSecureGetenv);
}
