// The names by which members of a swap barrier identify themselves to the leader.
#pragma once

#include <charconv>
#include <string>

namespace mural {

inline std::string barrierNameOf(int rank) { return "swap" + std::to_string(rank); }

// 0: not a valid name.
inline int barrierRankOf(const std::string& name) {
    int rank = 0;
    if (!name.starts_with("swap")) return 0;
    const auto [end, error] = std::from_chars(name.data() + 4, name.data() + name.size(), rank);
    return error == std::errc() && end == name.data() + name.size() ? rank : 0;
}

} // namespace mural
