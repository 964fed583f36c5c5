// What a walk over the records of a packet has passed: who takes the packet next need not walk again (docs/wire-format.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural {

// What is longer is told of, for who treats it otherwise (economy/).
inline constexpr size_t kMostShortRecordBytes = 1024;

struct Walked {
    size_t records = 0;
    size_t lastBytes = 0;         // of the last one
    std::vector<uint32_t> longAt; // where the long ones begin, bytes, in order

    void pass(size_t at, size_t sizeBytes) {
        ++records;
        lastBytes = sizeBytes;
        if (sizeBytes > kMostShortRecordBytes) longAt.push_back(static_cast<uint32_t>(at));
    }
    // What `next` has passed behind it.
    void add(const Walked& next) {
        if (next.records == 0) return;
        records += next.records;
        lastBytes = next.lastBytes;
        longAt.insert(longAt.end(), next.longAt.begin(), next.longAt.end());
    }
};

} // namespace mural
