// The X property by which the head recognizes a window that a captured program draws in. A window number alone is no
// proof: every X server uses the same numbers, and reuses them when a program ends.
//
// The program writes the property through its own connection, before its first picture of the window. The head reads it
// before each picture that it paints. Each program of a session has its own property, because two programs may draw in
// one window.
#pragma once

#include <cstdint>
#include <cstdio>

namespace mural::window_mark {

// Type CARDINAL, format 32. The value is the words of sessionKey(), low word first, then the program's numbers of the
// window's drawables.
constexpr uint32_t kKeyWords = 2;
constexpr uint32_t kMaxDrawables = 30; // GLX windows and EGL surfaces of one X window
constexpr uint32_t kMaxWords = kKeyWords + kMaxDrawables;

struct PropertyName {
    explicit PropertyName(uint32_t client) {
        length = static_cast<uint16_t>(std::snprintf(text, sizeof text, "_MURAL_WINDOW_%u", client));
    }
    char text[32];
    uint16_t length;
};

// FNV-1a hash of the session's name, as in MURAL_SESSION.
inline uint64_t sessionKey(const char* session) {
    uint64_t key = 0xcbf29ce484222325;
    for (; session && *session; ++session) key = (key ^ static_cast<unsigned char>(*session)) * 0x100000001b3;
    return key;
}

} // namespace mural::window_mark
