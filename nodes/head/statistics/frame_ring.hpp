// The statistics of the last frames. Pure; not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "nodes/head/statistics/frame_record.hpp"

namespace mural {

class FrameRing {
public:
    static constexpr size_t kFrames = 600;
    static constexpr int64_t kSettleNs = 100'000'000;     // after its end, for late tracks: the output of its picture
    static constexpr int64_t kPatienceNs = 2'000'000'000; // from its first track, for a frame without an end

    explicit FrameRing(size_t capacity = kFrames) : capacity_(capacity) {}

    // Adds a track to its frame. Drops the oldest frame if a new one finds the ring full.
    void add(uint32_t client, uint32_t frame, SpanTrack track, int64_t nowNs);
    // Sets the end of a frame. The first call counts.
    void finish(uint32_t client, uint32_t window, uint32_t frame, int64_t nowNs);
    void clear() { entries_.clear(); }

    // Returns the frames from this number on, in order, up to the first frame that may receive further tracks. newest:
    // limit of their number; older ones are left out.
    [[nodiscard]] std::vector<FrameRecord> since(uint64_t number, int64_t nowNs, size_t newest = kFrames) const;
    [[nodiscard]] size_t size() const { return entries_.size(); }

private:
    struct Entry {
        FrameRecord record;
        int64_t beganNs = 0;
    };
    Entry& of(uint32_t client, uint32_t frame, int64_t nowNs);

    const size_t capacity_;
    uint64_t next_ = 1;
    std::deque<Entry> entries_;
};

} // namespace mural
