// The stream as nodes behind a network get it: what they have had is not sent to them again (economy/). Packets are gathered
// to batches, which the caller sends.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "common/result.hpp"
#include "economy/batch_codec.hpp"
#include "economy/packer.hpp"

namespace mural {

// Since the start of the session.
struct EconomyCounts {
    bool on = false;
    economy::PackerCounts packer;
    uint64_t wireBytes = 0; // after compression, packet headers included
    uint64_t encodeNs = 0;  // CPU time of all of it
};

// One thread at a time (NodeSet's lock), but counts().
class StreamEconomy {
public:
    static Result<std::unique_ptr<StreamEconomy>> open(const economy::Limits& limits);

    void add(uint32_t stream, std::span<const std::byte> payload);

    [[nodiscard]] bool empty() const { return packets_ == 0; }
    // The batch should go now: nodes begin with what they have.
    [[nodiscard]] bool full();
    // Nodes can do nothing yet with what was added last: the rest of a value comes.
    [[nodiscard]] bool inValue() const { return packer_.endsInValue(); }
    // The batch, which lives until the next call; the next begins.
    Result<std::span<const std::byte>> take();
    void wrote(size_t sizeBytes, int64_t ns) { link_.wrote(sizeBytes, ns); }

    [[nodiscard]] EconomyCounts counts() const; // from any thread

private:
    explicit StreamEconomy(const economy::Limits& limits);
    void publishCounts();

    economy::Packer packer_;
    economy::BatchEncoder encoder_;
    economy::LinkRate link_;
    size_t packets_ = 0; // in the batch
    uint64_t wireBytes_ = 0, encodeNs_ = 0;
    struct Published {
        std::atomic<uint64_t> packets{0}, records{0}, rawBytes{0}, stagedBytes{0}, storeHits{0}, newPages{0}, patches{0}, wireBytes{0}, encodeNs{0};
    } published_;
};

} // namespace mural
