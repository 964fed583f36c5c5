// Sizes of the dictionary. Both sides need equal limits: the head sends its own to the nodes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "streamcodec/wire/record_offsets.hpp"

namespace mural::delta {

// Longer records consist of pages. Below this size three quarters of a 4 KiB page would be empty.
constexpr size_t kMaxTextBytes = kMaxShortRecordBytes;
constexpr size_t kPageBytes = 4096;
// Largest decoded size of one batch. Bounds the work of a node per read.
constexpr size_t kMaxBatchBytes = size_t{16} << 20;

struct Limits {
    uint64_t cacheBytes = uint64_t{1} << 30; // page store, shared by all streams
    uint32_t textBytes = 16u << 20;          // ring of short records, shared by all streams; a power of two
    uint32_t logItems = 1u << 20;            // per stream: 8 MiB when full (encoder: 12 MiB); a power of two
    uint32_t streams = 32;                   // streams with a log; the least recently used one loses its log
    uint32_t modelWords = 1u << 17;          // predictor state of changing entries, shared by all streams: 2 MiB

    [[nodiscard]] bool valid() const {
        const auto powerOfTwo = [](uint32_t n) { return n != 0 && (n & (n - 1)) == 0; };
        return cacheBytes >= kPageBytes && cacheBytes / kPageBytes < UINT32_MAX && powerOfTwo(textBytes) &&
               textBytes >= 4 * kMaxTextBytes && textBytes <= 1u << 30 && powerOfTwo(logItems) &&
               logItems <= 1u << 24 && streams >= 1 && streams <= 4096 && modelWords >= kMaxTextBytes &&
               modelWords <= 1u << 24;
    }
};

} // namespace mural::delta
