// The result of a walk over the records of a packet. The packet's next consumer need not walk again
// (docs/reference/wire-format.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural {

// Longer records are listed, for consumers that treat them separately (streamcodec/delta/).
inline constexpr size_t kMaxShortRecordBytes = 1024;

struct RecordOffsets {
    size_t records = 0;
    size_t lastBytes = 0;         // of the last record
    std::vector<uint32_t> longAt; // offsets of the long records in bytes, ascending

    void pass(size_t at, size_t sizeBytes) {
        ++records;
        lastBytes = sizeBytes;
        if (sizeBytes > kMaxShortRecordBytes) longAt.push_back(static_cast<uint32_t>(at));
    }
    // Appends the result of the following walk.
    void add(const RecordOffsets& next) {
        if (next.records == 0) return;
        records += next.records;
        lastBytes = next.lastBytes;
        longAt.insert(longAt.end(), next.longAt.begin(), next.longAt.end());
    }
};

} // namespace mural
