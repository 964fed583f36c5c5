// Bytes to another place. std::ranges::copy goes over const bytes one at a time (GCC 12 to 14, -O2): 0.6 GB/s instead of memcpy's
// 10, a sixth of what a sender of multicast needed of its core.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>

namespace mural {

// To where `to` begins, which has room for all of them; they do not overlap.
inline void copyBytes(std::span<const std::byte> from, std::span<std::byte> to) {
    if (!from.empty()) std::memcpy(to.data(), from.data(), from.size());
}

} // namespace mural
