// Encodes the stream for nodes on a network: delta coding (economy/) replaces data that the nodes have already. Packets
// are collected into batches, which the caller sends. The filter (holding/) precedes the coding.
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

// Totals since the start of the session.
struct EconomyCounts {
    bool on = false;
    economy::PackerCounts packer;
    holding::HolderCounts holder;
    uint64_t wireBytes = 0; // compressed, packet headers included
    uint64_t encodeNs = 0; // CPU time of the coding; for short packets extrapolated from samples
};

// Not thread-safe (NodeSet's lock), except counts().
class StreamEconomy {
public:
    static Result<std::unique_ptr<StreamEconomy>> open(const economy::Limits& limits);

    // The dictionary and the compressor, which start together.
    struct Coder {
        explicit Coder(const economy::Limits& limits);
        economy::Packer packer;
        economy::BatchEncoder encoder;
        economy::WayChoice way;
    };
    static Result<std::unique_ptr<Coder>> freshCoder(const economy::Limits& limits); // thread-safe
    // Replaces the dictionary. Nodes learn it at the same position of the stream (HeadCommand::NewHistory). Requires
    // empty(). Returns the old one, for destruction without the lock.
    [[nodiscard]] std::unique_ptr<Coder> beginAnew(std::unique_ptr<Coder> fresh);
    [[nodiscard]] const economy::Limits& limits() const { return limits_; }

    // May defer data that no later record uses yet (holding/).
    void add(uint32_t stream, std::span<const std::byte> payload);
    // Sets the function that takes and sends a full batch. add() may call it, because deferred data can be released in
    // bulk.
    void sendBy(std::function<void()> send) { send_ = std::move(send); }
    // Updates the filter's state with a packet that is not sent to any node.
    void miss(uint32_t stream, std::span<const std::byte> payload);
    void holdNothing() { holds_ = false; } // disables the filter; call before the first packet
    void losesWhatItHolds() { holder_.losesWhatItHolds(); } // fault injection for tests

    [[nodiscard]] bool empty() const { return packets_ == 0; }
    // True if the batch should be sent now: it is large enough for the nodes to start decoding.
    [[nodiscard]] bool full() const;
    // True inside a blob: nodes cannot use the last packet until the rest arrives.
    [[nodiscard]] bool inValue() const { return coder_->packer.endsInValue(); }
    // Returns the batch, valid until the next call, and starts a new one.
    Result<std::span<const std::byte>> take();
    void wrote(size_t sizeBytes, int64_t ns) { link_.wrote(sizeBytes, ns); }

    [[nodiscard]] EconomyCounts counts() const; // thread-safe

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
    bool missed_ = false; // output of the current packet
    int64_t (*nowNs_)() = threadCpuNowNs; // clock of the current packet
    int64_t sendNs_ = 0; // time in send_ since add() began
    std::unique_ptr<Coder> coder_;
    economy::PackerCounts before_; // counts of earlier dictionaries
    economy::LinkRate link_;
    size_t packets_ = 0; // packets in the batch
    bool timesFrame_ = true; // times every packet of this frame; otherwise long packets only
    bool timesPacking_ = false;
    uint64_t packNs_ = 0; // coding time of the current packet, without the filter
    UsualTimesBySize packetNs_; // from timed frames and the first packet of each size; without long packets
    UsualTime takeNs_; // the same, per batch
    uint64_t wireBytes_ = 0, encodeNs_ = 0;
    struct Measured {
        uint64_t rawBytes = 0, pageBytes = 0, leftOutBytes = 0, wireBytes = 0, encodeNs = 0, programBytes = 0, holdNs = 0;
    } measured_; // since the last choice of the coding, about one frame
    struct Published {
        std::atomic<uint64_t> packets{0}, records{0}, rawBytes{0}, stagedBytes{0}, storeHits{0}, newPages{0}, patches{0}, wireBytes{0}, encodeNs{0};
        std::atomic<uint64_t> holdInBytes{0}, holdOutBytes{0}, heldRecords{0}, leftOutRecords{0}, leftOutBytes{0}, heldBytes{0};
    } published_;
};

} // namespace mural
