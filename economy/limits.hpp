// How much packer and unpacker remember. Both must have the same: the head tells its nodes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "streamcodec/walked.hpp"

namespace mural::economy {

// Items above are pages. Below, a page of 4 KiB would be three quarters empty.
constexpr size_t kMostTextBytes = kMostShortRecordBytes;
constexpr size_t kPageBytes = 4096;
// What one batch may hold when it is unpacked: bounds what a node does for one read.
constexpr size_t kMostBatchBytes = size_t{16} << 20;

struct Limits {
    uint64_t storeBytes = uint64_t{1} << 30; // pages, of all streams
    uint32_t textBytes = 16u << 20;          // items that are no pages, of all streams; a power of two
    uint32_t logItems = 1u << 20;            // per stream: 8 MiB when full (packer: 12 MiB); a power of two
    uint32_t streams = 32;                   // with a log; the one unused for longest gives its up
    uint32_t modelWords = 1u << 17;          // of items that change, of all streams: 2 MiB

    [[nodiscard]] bool valid() const {
        const auto powerOfTwo = [](uint32_t n) { return n != 0 && (n & (n - 1)) == 0; };
        return storeBytes >= kPageBytes && storeBytes / kPageBytes < UINT32_MAX && powerOfTwo(textBytes) && textBytes >= 4 * kMostTextBytes && textBytes <= 1u << 30 &&
               powerOfTwo(logItems) && logItems <= 1u << 24 && streams >= 1 && streams <= 4096 && modelWords >= kMostTextBytes && modelWords <= 1u << 24;
    }
};

} // namespace mural::economy
