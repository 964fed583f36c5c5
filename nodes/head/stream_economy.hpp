// The stream as nodes behind a network get it: what they have had is not sent to them again (economy/). Packets are gathered
// to batches, which the caller sends. In front of that what nobody needs yet is held back (holding/).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "economy/batch_codec.hpp"
#include "economy/packer.hpp"
#include "economy/way_choice.hpp"
#include "holding/holder.hpp"
#include "holding/small_choice.hpp"
#include "nodes/head/usual_time.hpp"

namespace mural {

// Since the start of the session.
struct EconomyCounts {
    bool on = false;
    economy::PackerCounts packer;
    holding::HolderCounts holder;
    uint64_t wireBytes = 0; // after compression, packet headers included
    uint64_t encodeNs = 0;  // CPU time of all of it; of short packets some are measured, and stand for the others
};

// One thread at a time (NodeSet's lock), but counts().
class StreamEconomy {
public:
    static Result<std::unique_ptr<StreamEconomy>> open(const economy::Limits& limits);

    // What nodes have had, and how it is compressed: with it a history begins.
    struct Coder {
        explicit Coder(const economy::Limits& limits);
        economy::Packer packer;
        economy::BatchEncoder encoder;
        economy::WayChoice way;
    };
    static Result<std::unique_ptr<Coder>> freshCoder(const economy::Limits& limits); // from any thread
    // Nodes are told at the same place of the stream (HeadCommand::NewHistory). When empty(); returns the old one, to be freed
    // at leisure.
    [[nodiscard]] std::unique_ptr<Coder> beginAnew(std::unique_ptr<Coder> fresh);
    [[nodiscard]] const economy::Limits& limits() const { return limits_; }

    // What no record behind it has used yet may stay behind (holding/).
    void add(uint32_t stream, std::span<const std::byte> payload);
    // Takes and sends the batch when it is full, also in the middle of add(): much may come out at once of what stayed behind.
    void sendBy(std::function<void()> send) { send_ = std::move(send); }
    // Nobody gets it.
    void miss(uint32_t stream, std::span<const std::byte> payload);
    void holdNothing() { holds_ = false; } // before the first packet: all comes out as it came
    void losesWhatItHolds() { holder_.losesWhatItHolds(); } // a fault on purpose, for tests of the tests

    [[nodiscard]] bool empty() const { return packets_ == 0; }
    // The batch should go now: nodes begin with what they have, and it may not grow much.
    [[nodiscard]] bool full() const;
    // Nodes can do nothing yet with what was added last: the rest of a value comes.
    [[nodiscard]] bool inValue() const { return coder_->packer.endsInValue(); }
    // The batch, which lives until the next call; the next begins.
    Result<std::span<const std::byte>> take();
    void wrote(size_t sizeBytes, int64_t ns) { link_.wrote(sizeBytes, ns); }

    [[nodiscard]] EconomyCounts counts() const; // from any thread

private:
    StreamEconomy(const economy::Limits& limits, std::unique_ptr<Coder> coder);
    void publishCounts();
    [[nodiscard]] bool isMostLeftOut() const;

    void hold(uint32_t stream, std::span<const std::byte> payload);
    void pack(uint32_t stream, std::span<const std::byte> payload, const Walked* walked = nullptr);

    const economy::Limits limits_;
    holding::Holder holder_;
    holding::SmallChoice small_;
    std::function<void()> send_;
    bool holds_ = true;
    bool missed_ = false; // what comes out now
    int64_t (*nowNs_)() = threadCpuNowNs; // by which the packet in hand is timed
    int64_t sendNs_ = 0;  // of send_ since add() began
    std::unique_ptr<Coder> coder_;
    economy::PackerCounts before_; // of the histories before this one
    economy::LinkRate link_;
    size_t packets_ = 0; // in the batch
    bool timesFrame_ = true; // all that is done for it; else what is long only
    bool timesPacking_ = false;
    uint64_t packNs_ = 0; // of the packet in hand, without what holds back
    UsualTimesBySize packetNs_; // of packets of frames that are measured, and the first of each size, but long ones
    UsualTime takeNs_;          // of the batch, the same
    uint64_t wireBytes_ = 0, encodeNs_ = 0;
    struct Measured {
        uint64_t rawBytes = 0, pageBytes = 0, leftOutBytes = 0, wireBytes = 0, encodeNs = 0, programBytes = 0, holdNs = 0;
    } measured_; // since the way was chosen: about a frame
    struct Published {
        std::atomic<uint64_t> packets{0}, records{0}, rawBytes{0}, stagedBytes{0}, storeHits{0}, newPages{0}, patches{0}, wireBytes{0}, encodeNs{0};
        std::atomic<uint64_t> holdInBytes{0}, holdOutBytes{0}, heldRecords{0}, leftOutRecords{0}, leftOutBytes{0}, heldBytes{0};
    } published_;
};

} // namespace mural
