// Software prefetch: the hardware prefetches along a row and within a page only.
#pragma once

#include <cstddef>

namespace mural::compositor {

inline void prefetch(const void* from, size_t sizeBytes) {
    constexpr size_t kLineBytes = 64;
    for (size_t at = 0; at < sizeBytes; at += kLineBytes) __builtin_prefetch(static_cast<const char*>(from) + at);
}

} // namespace mural::compositor
