// Varints (LEB128): seven bits per byte, lowest first; the top bit announces another byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::delta {

inline void writeVarint(size_t n, std::vector<std::byte>& into) {
    for (; n >= 128; n >>= 7) into.push_back(static_cast<std::byte>(n | 128));
    into.push_back(static_cast<std::byte>(n));
}

// Reads a varint of up to 28 bits. Returns false if there is none.
[[nodiscard]] inline bool readVarint(std::span<const std::byte>& bytes, uint32_t& n) {
    n = 0;
    for (uint32_t shift = 0; shift < 28; shift += 7) {
        if (bytes.empty()) return false;
        const auto b = static_cast<uint32_t>(bytes[0]);
        bytes = bytes.subspan(1);
        n |= (b & 127) << shift;
        if (b < 128) return true;
    }
    return false;
}

} // namespace mural::delta
