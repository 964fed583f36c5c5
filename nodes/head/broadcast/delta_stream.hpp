// Encodes the stream for nodes on a network: delta coding (streamcodec/delta/) replaces data that the nodes have
// already. Packets are collected into batches, which the caller sends. The filter (streamcodec/filter/) precedes the
// coding.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "streamcodec/delta/batch_codec.hpp"
#include "streamcodec/delta/delta_encoder.hpp"
#include "streamcodec/delta/mode_selector.hpp"
#include "streamcodec/filter/command_filter.hpp"
#include "streamcodec/filter/redundancy_tuner.hpp"
#include "nodes/head/frames/median_timer.hpp"

namespace mural {

// Totals since the start of the session.
struct DeltaCounts {
    bool on = false;
    delta::DeltaEncoderCounts packer;
    filter::CommandFilterCounts filter;
    uint64_t wireBytes = 0; // compressed, packet headers included
    uint64_t encodeNs = 0;  // CPU time of the coding; for short packets extrapolated from samples
};

// Not thread-safe (StreamBroadcaster's lock), except counts().
class DeltaStream {
public:
    static Result<std::unique_ptr<DeltaStream>> open(const delta::Limits& limits);

    // The dictionary and the compressor, which start together.
    struct Coder {
        explicit Coder(const delta::Limits& limits);
        delta::DeltaEncoder deltaEncoder;
        delta::BatchEncoder batchEncoder;
        delta::ModeSelector mode;
    };
    static Result<std::unique_ptr<Coder>> freshCoder(const delta::Limits& limits); // thread-safe
    // Replaces the dictionary. Nodes replace theirs at the same position of the stream (HeadCommand::ResetDictionary).
    // Requires empty(). Returns the old one, for destruction without the lock.
    [[nodiscard]] std::unique_ptr<Coder> restart(std::unique_ptr<Coder> fresh);
    [[nodiscard]] const delta::Limits& limits() const { return limits_; }

    // May defer data that no later record uses yet (streamcodec/filter/).
    void add(uint32_t stream, std::span<const std::byte> payload);
    // Sets the function that takes and sends a full batch. add() may call it, because deferred data can be released in
    // bulk.
    void sendBy(std::function<void()> send) { send_ = std::move(send); }
    // Updates the filter's state with a packet that is not sent to any node.
    void miss(uint32_t stream, std::span<const std::byte> payload);
    void disableFilter() { filters_ = false; }                      // disables the filter; call before the first packet
    void losesDeferredUploads() { filter_.losesDeferredUploads(); } // fault injection for tests

    [[nodiscard]] bool empty() const { return packets_ == 0; }
    // True if the batch should be sent now: it is large enough for the nodes to start decoding.
    [[nodiscard]] bool full() const;
    // True inside a blob: nodes cannot use the last packet until the rest arrives.
    [[nodiscard]] bool inValue() const { return coder_->deltaEncoder.endsInValue(); }
    // Returns the batch, valid until the next call, and starts a new one.
    Result<std::span<const std::byte>> take();
    void wrote(size_t sizeBytes, int64_t ns) { link_.wrote(sizeBytes, ns); }

    [[nodiscard]] DeltaCounts counts() const; // thread-safe

private:
    DeltaStream(const delta::Limits& limits, std::unique_ptr<Coder> coder);
    void publishCounts();
    [[nodiscard]] bool isMostlyDropped() const;

    void filterPacket(uint32_t stream, std::span<const std::byte> payload);
    void encode(uint32_t stream, std::span<const std::byte> payload, const RecordOffsets* walked = nullptr);

    const delta::Limits limits_;
    filter::CommandFilter filter_;
    filter::RedundancyTuner redundancy_;
    std::function<void()> send_;
    bool filters_ = true;
    bool missed_ = false;                 // output of the current packet
    int64_t (*nowNs_)() = threadCpuNowNs; // clock of the current packet
    int64_t sendNs_ = 0;                  // time in send_ since add() began
    std::unique_ptr<Coder> coder_;
    delta::DeltaEncoderCounts before_; // counts of earlier dictionaries
    delta::LinkRate link_;
    size_t packets_ = 0;     // packets in the batch
    bool timesFrame_ = true; // times every packet of this frame; otherwise long packets only
    bool timesDelta_ = false;
    uint64_t deltaNs_ = 0;        // coding time of the current packet, without the filter
    MedianTimersBySize packetNs_; // from timed frames and the first packet of each size; without long packets
    MedianTimer takeNs_;          // the same, per batch
    uint64_t wireBytes_ = 0, encodeNs_ = 0;
    struct Measured {
        uint64_t rawBytes = 0, pageBytes = 0, droppedBytes = 0, wireBytes = 0, encodeNs = 0, programBytes = 0,
                 filterNs = 0;
    } measured_; // since the last choice of the coding, about one frame
    struct Published {
        std::atomic<uint64_t> packets{0}, records{0}, rawBytes{0}, stagedBytes{0}, pageHits{0}, newPages{0}, patches{0},
            wireBytes{0}, encodeNs{0};
        std::atomic<uint64_t> filterInBytes{0}, filterOutBytes{0}, deferredRecords{0}, droppedRecords{0},
            droppedBytes{0}, deferredBytes{0};
    } published_;
};

} // namespace mural
