// Frame ranges on the command line: 30 or 30-90, from 1.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace mural::cli {

inline std::optional<std::pair<int64_t, int64_t>> frameRangeOf(const std::string& text) {
    int64_t first = 0;
    const char* const end = text.data() + text.size();
    auto [at, error] = std::from_chars(text.data(), end, first);
    if (error != std::errc() || first < 1) return {};
    if (at == end) return std::pair(first, first);
    int64_t last = 0;
    if (*at != '-') return {};
    const auto second = std::from_chars(at + 1, end, last);
    if (second.ec != std::errc() || second.ptr != end || last < first) return {};
    return std::pair(first, last);
}

} // namespace mural::cli
