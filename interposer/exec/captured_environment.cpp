#include "interposer/exec/captured_environment.hpp"

#include <cstring>
#include <unistd.h>

#include "interposer/process/launch_settings.hpp"

namespace mural {

namespace {

constexpr char kPreload[] = "LD_PRELOAD=";
constexpr size_t kPreloadBytes = sizeof kPreload - 1;
constexpr size_t kMaxEntries = 8192; // limit for changed environments; their pointers take 64 KiB of the stack
constexpr char kLibrary[] = "libGLX_mural.so.0";
constexpr char kPreloadLibrary[] = "libmural_preload.so";

// The capture's variables at the start of this process, as complete entries.
struct Started {
    char preload[8192]; // our libraries in LD_PRELOAD, separated by spaces
    char session[256];
    char socketPath[256];
    char notes[256];
    char glxVendor[512];
    char eglVendors[8192];
};
Started started;

template <size_t N> void keepEntry(char (&into)[N], const char* name, const char* value) {
    if (!value || std::strlen(name) + std::strlen(value) + 2 > N) return;
    std::strcpy(into, name);
    std::strcat(into, "=");
    std::strcat(into, value);
}

bool endsWith(const char* text, size_t length, const char* end) {
    const size_t bytes = std::strlen(end);
    return length >= bytes && !std::strncmp(text + length - bytes, end, bytes) &&
           (length == bytes || text[length - bytes - 1] == '/');
}

const char* nextWord(const char*& at, size_t& length) {
    at += std::strspn(at, " :");
    const char* word = at;
    length = std::strcspn(at, " :");
    at += length;
    return length ? word : nullptr;
}

// Keeps the entries of our libraries. Entries without a folder depend on LD_LIBRARY_PATH and are ignored.
void keepPreload(const char* list) {
    size_t length = 0, used = 0;
    while (const char* word = nextWord(list, length)) {
        if (word[0] != '/' || !(endsWith(word, length, kLibrary) || endsWith(word, length, kPreloadLibrary))) continue;
        if (used + length + 2 > sizeof started.preload) return;
        if (used) started.preload[used++] = ' ';
        std::memcpy(started.preload + used, word, length);
        used += length;
        started.preload[used] = 0;
    }
}

// True for `mural run` inside a captured script. It deliberately starts the processes of its own session without
// capture.
bool isMural() {
    char path[4096];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
    return length > 0 && endsWith(path, static_cast<size_t>(length), "mural");
}

__attribute__((constructor)) void keepStarted() {
    const LaunchSettings& launch = launchSettings();
    if (!launch.session || isMural()) return;
    for (char** e = environ; e && *e; ++e)
        if (!std::strncmp(*e, kPreload, kPreloadBytes)) keepPreload(*e + kPreloadBytes);
    keepEntry(started.session, "MURAL_SESSION", launch.session);
    keepEntry(started.socketPath, "MURAL_SOCKET", launch.socketPath);
    keepEntry(started.notes, "MURAL_NOTES", launch.notes);
    keepEntry(started.glxVendor, "MURAL_REAL_GLX_VENDOR", launch.realGlxVendor);
    keepEntry(started.eglVendors, "MURAL_REAL_EGL_VENDORS", launch.realEglVendors);
}

bool isEntry(const char* entry, const char* name) {
    const size_t length = std::strlen(name);
    return !std::strncmp(entry, name, length) && entry[length] == '=';
}

bool isPreloaded(const char* list) {
    size_t length = 0;
    while (const char* word = nextWord(list, length))
        if (endsWith(word, length, kLibrary)) return true;
    return false;
}

const char* const kOurEntries[] = {started.session, started.socketPath, started.notes, started.glxVendor,
                                   started.eglVendors};

} // namespace

CapturedEnvironment::CapturedEnvironment(char* const* environment) : environment_(environment) {
    if (!started.preload[0]) return;
    bool hasSession = false;
    for (; environment && environment[count_]; ++count_) {
        const char* entry = environment[count_];
        // the new program must not be captured
        if (isEntry(entry, "MURAL_DISABLE") || isEntry(entry, "MURAL_NATIVE")) return;
        if (isEntry(entry, "LD_PRELOAD")) preload_ = entry;
        hasSession = hasSession || isEntry(entry, "MURAL_SESSION");
    }
    if (count_ > kMaxEntries || (hasSession && preload_ && isPreloaded(preload_ + kPreloadBytes))) return;
    const size_t preloadBytes =
        (preload_ ? std::strlen(preload_) : kPreloadBytes) + 1 + std::strlen(started.preload) + 1;
    neededBytes_ = (count_ + 2 + sizeof kOurEntries / sizeof kOurEntries[0]) * sizeof(char*) + preloadBytes;
}

char* const* CapturedEnvironment::build(void* memory) const {
    auto** entries = static_cast<char**>(memory);
    size_t count = 0;
    bool hasSession = false;
    for (size_t i = 0; i < count_; ++i) {
        hasSession = hasSession || isEntry(environment_[i], "MURAL_SESSION");
        if (environment_[i] != preload_) entries[count++] = environment_[i];
    }
    for (const char* entry : kOurEntries)
        if (!hasSession && entry[0]) entries[count++] = const_cast<char*>(entry);
    auto* preload = reinterpret_cast<char*>(entries + count_ + 2 + sizeof kOurEntries / sizeof kOurEntries[0]);
    entries[count++] = preload;
    entries[count] = nullptr;
    const bool hasOthers = preload_ && preload_[kPreloadBytes];
    std::strcpy(preload, hasOthers ? preload_ : kPreload);
    if (hasOthers) std::strcat(preload, " ");
    if (!hasOthers || !isPreloaded(preload_ + kPreloadBytes)) std::strcat(preload, started.preload);
    return entries;
}

} // namespace mural
