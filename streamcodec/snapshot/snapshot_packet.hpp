// A packet of a snapshot, for a node that resynchronizes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural::snapshot {

struct SnapshotPacket {
    uint32_t stream = 0;
    std::vector<std::byte> payload;
};

} // namespace mural::snapshot
