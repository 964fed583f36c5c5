// Records that no frame before had follow each other where a program loads, compiles lists, or draws what it never drew. To look at
// each takes two to three times as long as to compress them, so behind some of them the rest of the packet goes as bytes.
// Where the same come again, those few are found in the log, and what was left out behind them is looked at in that frame: one that
// repeats is known one frame later. What a stream's first frame has left out is not waited for: it loads what others draw, and to look at all of the
// second for that took most of its time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::economy {

// Of one stream. Positions are those of its log.
class NewRecords {
public:
    // In this frame; `end`: of the log. Of a long packet few are enough behind many of the packets before, and of any ever fewer, to none, behind those
    // of this frame whose rest was left out. A short one would win little; and between pages, which are looked at always, short records tell
    // where the log goes on.
    void packetBegins(uint64_t frame, uint64_t end, bool isLong) {
        packets_ = frame == frame_ && isLeftOut_ ? std::min(packets_ + 1, kMostHalved) : 0;
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
    // Most of its bytes were in pages: most likely those of the next one are, too.
    void packetEnds(bool mostIsPages) { hadPages_ = mostIsPages; }
    // So many came as they did from `position` on: in a frame before, or only in this one.
    void found(uint64_t position, size_t records) {
        if (position >= frameBegan_) late_ += static_cast<uint32_t>(std::min<size_t>(records, kMany));
        else late_ -= static_cast<uint32_t>(std::min<size_t>(late_, records * kFoundCounts));
    }
    void isNew() { ++late_; }
    // Another comes than the log has at `cursor`: what was left out there in a frame before?
    void another(uint64_t cursor) { again_ = again_ || (next_ != 0 && cursor <= frameBegan_ && std::ranges::find(leftOutAt_, cursor) != leftOutAt_.end()); }

    [[nodiscard]] bool many() const { return late_ >= kMany && !again_; }
    // What follows goes as bytes; `position`: where it would have stood.
    void leaveOut(uint64_t position) {
        if (!isFirstFrame_) leftOutAt_[next_++ % leftOutAt_.size()] = position;
        isLeftOut_ = true;
    }

private:
    static constexpr uint32_t kMany = 64;
    static constexpr uint32_t kAtLeast = 32, kFew = 4; // of a packet, behind many
    static constexpr uint32_t kMostHalved = 3;         // to four; to none
    static constexpr uint32_t kFoundCounts = 3; // one that is found weighs as many new ones
    static constexpr uint64_t kNever = UINT64_MAX;
    static constexpr size_t kPlaces = 16;       // packets of a frame, about

    uint32_t late_ = 0;      // new ones, less those found
    bool isLeftOut_ = false; // the rest of the packet
    bool hadPages_ = false;  // the packet before
    uint32_t packets_ = 0;   // of this frame that had a rest left out, up to the last one
    bool again_ = false;     // in this frame something came that was left out before
    uint64_t frame_ = kNever, frameBegan_ = kNever;
    bool isFirstFrame_ = true;
    std::array<uint64_t, kPlaces> leftOutAt_ = nowhere();
    size_t next_ = 0;

    static constexpr std::array<uint64_t, kPlaces> nowhere() {
        std::array<uint64_t, kPlaces> places{};
        places.fill(kNever);
        return places;
    }
};

} // namespace mural::economy
