// Methods of stream compression: Mural's own, and competitors. Each processes the same packets in the same order,
// alone, as in a head between two frames, and reports bytes and CPU time per frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "tools/bench/stream/frames.hpp"

namespace mural::bench {

class StreamCoding {
public:
    virtual ~StreamCoding() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    virtual void packet(const StreamPacket& packet) = 0;
    // Ends the frame; returns its size as sent.
    virtual Result<uint64_t> frameEnds() = 0;
    // After all frames, for each packet again: checks the decoded result.
    virtual Result<void> comesOut(const StreamPacket& /*packet*/) { return {}; }
    // Total CPU time, without assembling packets and comparing results.
    [[nodiscard]] virtual int64_t cpuNs() const = 0;
};

// Mural as in the head: command filter, then delta coding.
Result<std::unique_ptr<StreamCoding>> filteredDeltaCoding(uint64_t cacheBytes);
// Delta coding without the filter: batches are kept, decoded and compared.
Result<std::unique_ptr<StreamCoding>> unfilteredDeltaCoding(uint64_t cacheBytes);
// Zstandard over each whole frame.
std::unique_ptr<StreamCoding> zstdCoding(int level);
// Omits commands equal to the one at the same position of the previous frame; LZ4 over the rest. Source: Neal, Hunkin,
// McGregor, "Distributed OpenGL rendering in network bandwidth constrained environments" (ClusterGL), 2011.
std::unique_ptr<StreamCoding> differenceCoding();

} // namespace mural::bench
