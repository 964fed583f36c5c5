// Keys of browsers as keycodes of an X server. Pure.
//
// Source: KeyboardEvent.key values of "UI Events KeyboardEvent key Values", W3C 2017; keysyms of "X Window System
// Protocol", appendix A; Unicode keysyms are 0x01000000 plus the code point.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace mural::input {

using Keysym = uint32_t;
inline constexpr Keysym kNoKeysym = 0;

// Returns the keysym of a code point.
[[nodiscard]] Keysym keysymOf(char32_t character);
// Returns the keysym of KeyboardEvent.key. code: KeyboardEvent.code, which tells left from right. kNoKeysym: the key
// has no meaning for a program, such as "Dead".
[[nodiscard]] Keysym keysymOfKey(std::string_view key, std::string_view code);
// Returns the code points of a text. Invalid bytes are left out.
[[nodiscard]] std::vector<char32_t> codePointsOf(std::string_view utf8);

enum class KeyLevel : uint8_t { Plain, Shift, Level3, ShiftLevel3 };

struct KeyPlace {
    uint8_t keycode = 0;
    KeyLevel level = KeyLevel::Plain;
};

// The keyboard mapping of an X server: the keysyms of each keycode.
class KeyboardMap {
public:
    KeyboardMap() = default;
    // keysyms: `perKeycode` of each keycode from `first` on, as GetKeyboardMapping returns them.
    KeyboardMap(uint8_t first, int perKeycode, std::vector<Keysym> keysyms);

    // Returns the keycode and level of a keysym; the lowest level, then the lowest keycode. nullopt: it has none.
    [[nodiscard]] std::optional<KeyPlace> find(Keysym keysym) const;
    // Returns the keycodes without keysyms.
    [[nodiscard]] std::vector<uint8_t> freeKeycodes() const;
    // Notes that a keycode got this keysym on all levels.
    void bind(uint8_t keycode, Keysym keysym);
    [[nodiscard]] int perKeycode() const { return perKeycode_; }

private:
    [[nodiscard]] Keysym at(size_t keycode, int column) const;
    [[nodiscard]] bool hasAt(size_t keycode, KeyLevel level, Keysym keysym) const;

    uint8_t first_ = 0;
    int perKeycode_ = 0;
    std::vector<Keysym> keysyms_;
};

} // namespace mural::input
