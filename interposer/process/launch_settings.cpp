#include "interposer/process/launch_settings.hpp"

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <unistd.h>

namespace mural {

namespace {

LaunchSettings settings{};
bool isRead = false;
char storage[16384]; // holds all values; setproctitle() and similar calls overwrite the environment's own memory
size_t used = 0;

// Does not call getenv, which this library replaces and which may run before its constructors.
const char* valueOf(const char* name) {
    const size_t length = std::strlen(name);
    for (char** e = environ; e && *e; ++e)
        if (!std::strncmp(*e, name, length) && (*e)[length] == '=') return *e + length + 1;
    return nullptr;
}

// Returns a permanent copy; null if the variable is missing, empty or too long.
const char* copyOfVariable(const char* name) {
    const char* value = valueOf(name);
    const size_t bytes = value ? std::strlen(value) + 1 : 0;
    if (bytes <= 1 || bytes > sizeof storage - used) return nullptr;
    char* copy = storage + used;
    std::memcpy(copy, value, bytes);
    used += bytes;
    return copy;
}

__attribute__((constructor)) void readSettings() {
    if (__atomic_exchange_n(&isRead, true, __ATOMIC_ACQ_REL)) return;
    settings.native = copyOfVariable("MURAL_NATIVE");
    settings.nativeReport = copyOfVariable("MURAL_NATIVE_REPORT");
    settings.nativeFrames = copyOfVariable("MURAL_NATIVE_FRAMES");
    settings.realGlxVendor = copyOfVariable("MURAL_REAL_GLX_VENDOR");
    settings.realEglVendors = copyOfVariable("MURAL_REAL_EGL_VENDORS");
    if (valueOf("MURAL_DISABLE")) return;
    settings.session = copyOfVariable("MURAL_SESSION");
    settings.socketPath = copyOfVariable("MURAL_SOCKET");
    settings.notes = copyOfVariable("MURAL_NOTES");
}

} // namespace

const LaunchSettings& launchSettings() {
    readSettings(); // another library's constructor may run first
    return settings;
}

} // namespace mural
