// Common code of the GLX and EGL entries. An entry wraps a GL library: it handles contexts, bindings and swaps itself,
// returns wrappers for GL commands, and forwards everything else.
#pragma once

#include <cstddef>
#include <cstdint>

#include "interposer/encode/real_gl.hpp"

namespace mural {

// A function that replaces the library's own.
struct OwnEntry {
    const char* name;
    Entry entry;
};
template <class F> OwnEntry ownEntry(const char* name, F* function) {
    return {name, reinterpret_cast<Entry>(function)};
}

class WrappedLibrary {
public:
    template <size_t N>
    constexpr WrappedLibrary(const char* windowSystem, const OwnEntry (&own)[N])
        : windowSystem_(windowSystem), own_(own), count_(N) {}

    // Sets the wrapped library, from which functions and GL commands are loaded.
    void attach(Loader library);
    [[nodiscard]] bool attached() const { return library_ != nullptr; }
    [[nodiscard]] Entry behind(const char* name) const { return library_ ? library_(name) : nullptr; }
    // The function that a program receives for a name: ours, a wrapper, the library's own, or null if none exists.
    [[nodiscard]] Entry entryFor(const char* name) const;
    // The same; null if the library's own applies.
    [[nodiscard]] Entry replacementFor(const char* name) const;

private:
    const char* windowSystem_; // prefix of the window system's functions
    const OwnEntry* own_;
    size_t count_;
    Loader library_ = nullptr;
};

// Both entries feed one encoder, but only the first one used is active. A library that the preloaded
// entry wraps may itself call GLVND, and its calls would arrive twice.
enum class EntryKind : int { Unclaimed, Vendor, Preload };
bool claimProgram(EntryKind kind);

// Forbids GLVND to patch its entry points, because patched ones would bypass the wrappers.
template <class Imports> void forbidPatching(Imports& imports) {
    imports.isPatchSupported = nullptr;
    imports.initiatePatch = nullptr;
    imports.releasePatch = nullptr;
    imports.patchThreadAttach = nullptr;
}

inline uint8_t clampByte(int v) { return static_cast<uint8_t>(v < 0 ? 0 : v > 255 ? 255 : v); }

// The GLX and EGL entries. GLVND or the preloaded entry attaches them.
WrappedLibrary& glxLibrary();
WrappedLibrary& eglLibrary();

} // namespace mural
