// Sizes on the command line: 65536, 512KiB, 64MiB, 1GiB.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace mural::cli {

inline std::optional<int64_t> byteSizeOf(std::string_view text) {
    int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number < 0) return {};
    const std::string_view unit = text.substr(static_cast<size_t>(end - text.data()));
    constexpr std::pair<std::string_view, int> kUnits[] = {{"", 0}, {"KiB", 10}, {"MiB", 20}, {"GiB", 30}};
    for (const auto& [name, shift] : kUnits)
        if (unit == name) return number <= INT64_MAX >> shift ? std::optional(number << shift) : std::nullopt;
    return {};
}

} // namespace mural::cli
