// A reader's side of a queue: requests items before they are needed. A state machine without sockets, clocks and
// threads.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/base/result.hpp"
#include "objects/core/blob_intake.hpp"
#include "objects/core/message_sink.hpp"

namespace mural::objects {

// The reader holds one item more than are finished during a round trip to the writer: 1 + round trip / mean time of an
// item, at most kMaxMark. Both times are measured.
//
// Thread safety: none.
class ObjectQueueReader {
public:
    ObjectQueueReader(MessageSink& sink, uint32_t queue) : sender_(sink), queue_(queue) {}

    static constexpr uint32_t kMaxMark = 16;

    struct Item {
        uint64_t number = 0;
        uint64_t frame = 0;
        std::vector<std::byte> bytes;
    };
    // Returns the next item, and reports the previous one as finished. Empty: none has arrived, or the queue has ended.
    std::optional<Item> pop(int64_t nowNs);
    // Reports the item of the last pop() as finished, if it is not yet.
    void finish(int64_t nowNs);
    // Drops received items of frames before `frame`.
    void dropBefore(uint64_t frame) { oldestFrame_ = frame; }

    void input(const ItemMessage& message, int64_t nowNs);
    void input(const ClosedMessage&) { hasEnded_ = true; }

    [[nodiscard]] bool hasEnded() const { return hasEnded_ && items_.empty(); } // closed and empty
    [[nodiscard]] uint32_t mark() const;

private:
    void ask(int64_t nowNs);
    // Updates a mean that follows changes within about 8 values.
    static void average(double& mean, double value) { mean = mean == 0 ? value : mean + (value - mean) / 8; }

    MessageSender sender_;
    const uint32_t queue_;
    std::deque<Item> items_;
    uint32_t asked_ = 0;    // items on their way
    int64_t askedNs_ = 0;   // time of the request that is measured; 0: none
    uint64_t current_ = 0;  // item in use; 0: none
    int64_t currentNs_ = 0; // begin of its use
    uint64_t oldestFrame_ = 0;
    double roundTripNs_ = 0, itemNs_ = 0; // means; 0: not measured
    bool hasEnded_ = false;
};

} // namespace mural::objects
