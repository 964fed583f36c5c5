// What the fronts share. A front stands before a library that really draws, keeps for itself what makes
// contexts, binds them and shows pictures, gives out wrappers for GL commands, and passes on the rest.
#pragma once

#include <cstddef>
#include <cstdint>

#include "interposer/real_gl.hpp"

namespace mural {

// A function that Mural has instead of the library's own.
struct OwnEntry {
    const char* name;
    Entry entry;
};
template <class F> OwnEntry ownEntry(const char* name, F* function) { return {name, reinterpret_cast<Entry>(function)}; }

class Front {
public:
    template <size_t N> constexpr Front(const char* windowSystem, const OwnEntry (&own)[N]) : windowSystem_(windowSystem), own_(own), count_(N) {}

    // The library behind: where its functions come from. GL commands are looked up there, too.
    void attach(Loader library);
    [[nodiscard]] bool attached() const { return library_ != nullptr; }
    [[nodiscard]] Entry behind(const char* name) const { return library_ ? library_(name) : nullptr; }
    // What a program gets for the name: ours, a wrapper, the library's own, or null when it has none.
    [[nodiscard]] Entry entryFor(const char* name) const;
    // The same, null where the library's own is right.
    [[nodiscard]] Entry replacementFor(const char* name) const;

private:
    const char* windowSystem_; // what the names of its own functions begin with
    const OwnEntry* own_;
    size_t count_;
    Loader library_ = nullptr;
};

// Both ways into a program feed one encoder, and only one of them does, the one that is asked first: a
// library behind the preloaded front may itself go through GLVND, and its calls would arrive twice.
enum class Way : int { Open, Vendor, Preload };
bool claimProgram(Way way);

// Patched entry points would go round the wrappers.
template <class Imports> void forbidPatching(Imports& imports) {
    imports.isPatchSupported = nullptr;
    imports.initiatePatch = nullptr;
    imports.releasePatch = nullptr;
    imports.patchThreadAttach = nullptr;
}

inline uint8_t clampByte(int v) { return static_cast<uint8_t>(v < 0 ? 0 : v > 255 ? 255 : v); }

// The fronts of GLX and EGL; each is attached by GLVND or by the preloaded front.
Front& glxFront();
Front& eglFront();

} // namespace mural
