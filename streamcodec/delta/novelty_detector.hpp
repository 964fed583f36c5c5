// Detects runs of new records, as when a program loads, compiles lists, or draws something for the first time. Delta
// coding of new records takes two to three times as long as compressing them, so after some of them the rest of the
// packet is sent plain.
//
// When the same records repeat, the few coded ones are found in the log, and the plain rest after them is coded in that
// frame; a repeating frame is thus known one frame later. The rest of a stream's first frame is not waited for: it
// loads what later frames draw, and coding all of the second frame would take most of its time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::delta {

// State of one stream. Positions refer to its log.
class NoveltyDetector {
public:
    // Begins a packet; `end`: the end of the log. At least a threshold of its new records is coded. The threshold is
    // - kAtLeast for a short packet, which would gain little, and between pages: pages are always coded, and the short
    //   records between them resynchronize the log;
    // - kFew for a long packet, and after a packet of this frame with a plain rest.
    // Each packet of this frame with a plain rest halves the threshold.
    void packetBegins(uint64_t frame, uint64_t end, bool isLong) {
        packets_ = frame == frame_ && isLeftOut_ ? std::min(packets_ + 1, kMaxHalved) : 0;
        isLeftOut_ = false;
        const bool few = (isLong || packets_ > 0) && !hadPages_;
        const uint32_t enough = (few ? kFew : kAtLeast) >> packets_;
        late_ = std::min(late_, kMany - enough);
        if (frame == frame_) return;
        frame_ = frame;
        isFirstFrame_ = frameBegan_ == kNever;
        frameBegan_ = end;
        again_ = false;
    }
    // Pages dominated this packet, and probably dominate the next one.
    void packetEnds(bool isMainlyPages) { hadPages_ = isMainlyPages; }
    // Reports records that repeat from `position` on, in this frame or an earlier one.
    void found(uint64_t position, size_t records) {
        if (position >= frameBegan_)
            late_ += static_cast<uint32_t>(std::min<size_t>(records, kMany));
        else
            late_ -= static_cast<uint32_t>(std::min<size_t>(late_, records * kFoundCounts));
    }
    void isNew() { ++late_; }
    // Reports a record that differs from the log at `cursor`. Detects whether records were sent plain there in an
    // earlier frame.
    void another(uint64_t cursor) {
        again_ =
            again_ || (next_ != 0 && cursor <= frameBegan_ && std::ranges::find(plainAt_, cursor) != plainAt_.end());
    }

    [[nodiscard]] bool many() const { return late_ >= kMany && !again_; }
    // The rest is sent plain; `position`: where it would have been in the log.
    void sendRestPlain(uint64_t position) {
        if (!isFirstFrame_) plainAt_[next_++ % plainAt_.size()] = position;
        isLeftOut_ = true;
    }

private:
    static constexpr uint32_t kMany = 64;
    static constexpr uint32_t kAtLeast = 32, kFew = 4; // thresholds, see packetBegins()
    static constexpr uint32_t kMaxHalved = 3;          // halvings: kAtLeast becomes 4, kFew becomes 0
    static constexpr uint32_t kFoundCounts = 3;        // one repeated record outweighs this number of new ones
    static constexpr uint64_t kNever = UINT64_MAX;
    static constexpr size_t kSlots = 16; // approximate number of packets of a frame

    uint32_t late_ = 0;      // new records, less repeated ones
    bool isLeftOut_ = false; // the rest of the packet is sent plain
    bool hadPages_ = false;  // pages dominated the previous packet
    uint32_t packets_ = 0;   // packets of this frame with a plain rest
    bool again_ = false;     // a record that was sent plain before has repeated in this frame
    uint64_t frame_ = kNever, frameBegan_ = kNever;
    bool isFirstFrame_ = true;
    std::array<uint64_t, kSlots> plainAt_ = nowhere();
    size_t next_ = 0;

    static constexpr std::array<uint64_t, kSlots> nowhere() {
        std::array<uint64_t, kSlots> slots{};
        slots.fill(kNever);
        return slots;
    }
};

} // namespace mural::delta
