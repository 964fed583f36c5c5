// What a walk over the records of a packet has passed: who takes the packet next need not walk again (docs/wire-format.md).
#pragma once

#include <algorithm>
#include <cstddef>

namespace mural {

struct Walked {
    size_t records = 0;
    size_t lastBytes = 0, longestBytes = 0; // of records
    void pass(size_t sizeBytes) {
        ++records;
        lastBytes = sizeBytes;
        longestBytes = std::max(longestBytes, sizeBytes);
    }
};

} // namespace mural
