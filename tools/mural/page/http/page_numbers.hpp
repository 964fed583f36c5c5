// Numbers in queries, paths and options. Pure.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace mural::page {

// Returns the whole number; nullopt: it is none, or out of range.
[[nodiscard]] inline std::optional<int> wholeNumber(std::string_view text, int least, int most) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < least || number > most)
        return std::nullopt;
    return number;
}

} // namespace mural::page
