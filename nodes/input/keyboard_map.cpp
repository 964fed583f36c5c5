#include "nodes/input/keyboard_map.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace mural::input {

namespace {

constexpr Keysym kUnicodeKeysym = 0x01000000;
constexpr char32_t kMaxCodePoint = 0x10ffff;

struct NamedKey {
    std::string_view name;
    Keysym keysym;
};

// Keys with a name of more than one character.
constexpr std::array kNamedKeys = std::to_array<NamedKey>({
    {"Backspace", 0xff08},   {"Tab", 0xff09},         {"Enter", 0xff0d},     {"Escape", 0xff1b},
    {"Delete", 0xffff},      {"Home", 0xff50},        {"ArrowLeft", 0xff51}, {"ArrowUp", 0xff52},
    {"ArrowRight", 0xff53},  {"ArrowDown", 0xff54},   {"PageUp", 0xff55},    {"PageDown", 0xff56},
    {"End", 0xff57},         {"Insert", 0xff63},      {"Pause", 0xff13},     {"ScrollLock", 0xff14},
    {"PrintScreen", 0xff61}, {"ContextMenu", 0xff67}, {"NumLock", 0xff7f},   {"CapsLock", 0xffe5},
    {"Shift", 0xffe1},       {"Control", 0xffe3},     {"Alt", 0xffe9},       {"Meta", 0xffeb},
    {"AltGraph", 0xfe03},    {"Help", 0xff6a},        {"Undo", 0xff65},      {"Find", 0xff68},
});

// Modifiers of the right side.
constexpr std::array kRightKeys = std::to_array<NamedKey>(
    {{"ShiftRight", 0xffe2}, {"ControlRight", 0xffe4}, {"AltRight", 0xffea}, {"MetaRight", 0xffec}});

Keysym namedIn(const auto& table, std::string_view name) {
    const auto found = std::ranges::find(table, name, &NamedKey::name);
    return found != table.end() ? found->keysym : kNoKeysym;
}

// Returns F1 to F24.
Keysym functionKey(std::string_view key) {
    constexpr Keysym kF1 = 0xffbe;
    if (key.size() < 2 || key.size() > 3 || key.front() != 'F') return kNoKeysym;
    unsigned number = 0;
    for (const char c : key.substr(1)) {
        if (c < '0' || c > '9') return kNoKeysym;
        number = number * 10 + static_cast<unsigned>(c - '0');
    }
    return number >= 1 && number <= 24 ? kF1 + number - 1 : kNoKeysym;
}

} // namespace

Keysym keysymOf(char32_t character) {
    if (character == '\n' || character == '\r') return 0xff0d;
    if (character == '\t') return 0xff09;
    const bool isLatin = (character >= 0x20 && character <= 0x7e) || (character >= 0xa0 && character <= 0xff);
    if (isLatin) return static_cast<Keysym>(character);
    return character > 0xff && character <= kMaxCodePoint ? kUnicodeKeysym + static_cast<Keysym>(character) : kNoKeysym;
}

Keysym keysymOfKey(std::string_view key, std::string_view code) {
    if (const Keysym right = namedIn(kRightKeys, code); right != kNoKeysym && key != "AltGraph") return right;
    if (const Keysym named = namedIn(kNamedKeys, key); named != kNoKeysym) return named;
    if (const Keysym function = functionKey(key); function != kNoKeysym) return function;
    const auto characters = codePointsOf(key);
    return characters.size() == 1 ? keysymOf(characters.front()) : kNoKeysym;
}

std::vector<char32_t> codePointsOf(std::string_view utf8) {
    std::vector<char32_t> result;
    for (size_t at = 0; at < utf8.size();) {
        const auto lead = static_cast<unsigned char>(utf8[at]);
        const size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 0;
        if (length == 0 || at + length > utf8.size()) {
            ++at;
            continue;
        }
        char32_t character = length == 1 ? lead : lead & (0x7fU >> length);
        bool isValid = true;
        for (size_t i = 1; i < length; ++i) {
            const auto next = static_cast<unsigned char>(utf8[at + i]);
            isValid = isValid && (next & 0xc0) == 0x80;
            character = (character << 6) | (next & 0x3f);
        }
        if (isValid && character <= kMaxCodePoint) result.push_back(character);
        at += isValid ? length : 1;
    }
    return result;
}

KeyboardMap::KeyboardMap(uint8_t first, int perKeycode, std::vector<Keysym> keysyms)
    : first_(first), perKeycode_(perKeycode), keysyms_(std::move(keysyms)) {}

Keysym KeyboardMap::at(size_t keycode, int column) const {
    const size_t index = keycode * static_cast<size_t>(perKeycode_) + static_cast<size_t>(column);
    return column < perKeycode_ && index < keysyms_.size() ? keysyms_[index] : kNoKeysym;
}

// The core protocol has groups 1 and 2 in the columns 0 to 3. XKB servers add the levels 3 and 4 of group 1 in 4 and 5.
bool KeyboardMap::hasAt(size_t keycode, KeyLevel level, Keysym keysym) const {
    constexpr std::array<int, 4> kColumns = {0, 1, 4, 5};
    if (at(keycode, kColumns[static_cast<size_t>(level)]) == keysym) return true;
    // A letter alone in the first column has its capital with Shift.
    const bool isCapital = keysym >= 'A' && keysym <= 'Z';
    return level == KeyLevel::Shift && isCapital && at(keycode, 1) == kNoKeysym && at(keycode, 0) == keysym - 'A' + 'a';
}

std::optional<KeyPlace> KeyboardMap::find(Keysym keysym) const {
    if (perKeycode_ == 0 || keysym == kNoKeysym) return std::nullopt;
    const size_t keycodes = keysyms_.size() / static_cast<size_t>(perKeycode_);
    for (const KeyLevel level : {KeyLevel::Plain, KeyLevel::Shift, KeyLevel::Level3, KeyLevel::ShiftLevel3})
        for (size_t keycode = 0; keycode < keycodes; ++keycode)
            if (hasAt(keycode, level, keysym)) return KeyPlace{static_cast<uint8_t>(first_ + keycode), level};
    return std::nullopt;
}

std::vector<uint8_t> KeyboardMap::freeKeycodes() const {
    std::vector<uint8_t> result;
    if (perKeycode_ == 0) return result;
    for (size_t keycode = 0; keycode < keysyms_.size() / static_cast<size_t>(perKeycode_); ++keycode) {
        bool isFree = true;
        for (int column = 0; column < perKeycode_; ++column) isFree = isFree && at(keycode, column) == kNoKeysym;
        if (isFree) result.push_back(static_cast<uint8_t>(first_ + keycode));
    }
    return result;
}

void KeyboardMap::bind(uint8_t keycode, Keysym keysym) {
    const size_t begin = static_cast<size_t>(keycode - first_) * static_cast<size_t>(perKeycode_);
    for (size_t i = begin; i < begin + static_cast<size_t>(perKeycode_) && i < keysyms_.size(); ++i)
        keysyms_[i] = keysym;
}

} // namespace mural::input
