// Ways to make a frame's stream small: Mural's own, and what it is measured against. Each sees the same packets in the same
// order, alone, as nothing else works between two frames in a head either, and gives the bytes of each frame, and the CPU time that they took.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/result.hpp"
#include "tools/bench/stream/frames.hpp"

namespace mural::bench {

class Way {
public:
    virtual ~Way() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    virtual void packet(const StreamPacket& packet) = 0;
    // Of the frame that ends: bytes as they would be sent.
    virtual Result<uint64_t> frameEnds() = 0;
    // Behind all frames, for each packet once more: is it what comes out at the other end?
    virtual Result<void> comesOut(const StreamPacket& /*packet*/) { return {}; }
    // CPU time of all so far, without gathering packets and without what is only compared.
    [[nodiscard]] virtual int64_t cpuNs() const = 0;
};

// The economy, as the head uses it: what nobody needs yet stays behind, the rest is packed.
Result<std::unique_ptr<Way>> sentWay(uint64_t storeBytes);
// All of it packed, and nothing held: every batch is kept, to be unpacked and compared.
Result<std::unique_ptr<Way>> allPackedWay(uint64_t storeBytes);
// Zstandard over the whole frame, by itself.
std::unique_ptr<Way> zstdWay(int level);
// Commands that are as the one at their place in the frame before are left out; LZ4 over the rest.
// Source: Neal, Hunkin, McGregor, "Distributed OpenGL rendering in network bandwidth constrained environments" (ClusterGL), 2011.
std::unique_ptr<Way> differenceWay();

} // namespace mural::bench
