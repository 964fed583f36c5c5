// Caches recent runs of short records with contiguous bytes, so an equal frame is one comparison instead of one per
// record. Encoder only. The bytes of single entries are scattered over the ring, each where it was new.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "streamcodec/delta/dictionary/entry_log.hpp"
#include "streamcodec/delta/dictionary/large_array.hpp"

namespace mural::delta {

class RunCache {
public:
    static constexpr size_t kMinItems = 16; // shorter runs are compared as fast entry by entry

    struct Run {
        uint64_t position = 0;   // position of the first entry in the log
        uint64_t bytesAt = 0;    // offset of its bytes, counted from the start of the stream
        uint64_t oldestText = 0; // RecordRing::written() at the time of its oldest entry
        uint32_t items = 0, sizeBytes = 0;
    };

    // Adds a run. Requires ascending positions.
    void add(const Run& run) { runs_[end_++ % runs_.size()] = run; }
    // Stores the bytes of a run and returns their offset. Requires at most kMaxBytes.
    uint64_t keep(std::span<const std::byte> bytes) {
        if (const uint64_t at = bytesEnd_ % kMaxBytes; at + bytes.size() > kMaxBytes) bytesEnd_ += kMaxBytes - at;
        std::memcpy(bytes_.data() + bytesEnd_ % kMaxBytes, bytes.data(), bytes.size());
        bytesEnd_ += bytes.size();
        return bytesEnd_ - bytes.size();
    }

    // Returns the known run at the log's cursor; `items` 0: none. Fast while the cursor moves forward.
    [[nodiscard]] Run fromCursor(const EntryLog& log) {
        const auto at = [this](uint64_t i) -> const Run& { return runs_[i % runs_.size()]; };
        const uint64_t position = log.cursor;
        const auto behind = [&](uint64_t i) { return at(i).position + at(i).items > position; };
        if (position < seen_ || end_ - next_ > runs_.size() ||
            (end_ - next_ > kMaxSteps && !behind(next_ + kMaxSteps))) {
            uint64_t first = end_ < runs_.size() ? 0 : end_ - runs_.size();
            for (uint64_t last = end_; first < last;) { // first run after the cursor
                const uint64_t middle = first + (last - first) / 2;
                behind(middle) ? last = middle : first = middle + 1;
            }
            next_ = first;
            within_ = {};
        }
        seen_ = position;
        for (; next_ < end_ && !behind(next_); ++next_) within_ = {};
        if (next_ == end_ || at(next_).position > position) return {};
        Run run = at(next_);
        if (run.bytesAt + kMaxBytes < bytesEnd_ || !log.contains(run.position)) return {};
        for (; run.position + within_.items < position; ++within_.items)
            within_.sizeBytes += log.at(run.position + within_.items).sizeBytes;
        return {position, run.bytesAt + within_.sizeBytes, run.oldestText, run.items - within_.items,
                run.sizeBytes - within_.sizeBytes};
    }
    [[nodiscard]] const std::byte* bytesOf(const Run& run) const { return bytes_.data() + run.bytesAt % kMaxBytes; }

    static constexpr size_t kMaxBytes = size_t{4} << 20;

private:
    static constexpr uint64_t kMaxSteps = 4; // more distant runs are found by binary search
    struct Within {
        uint32_t items = 0, sizeBytes = 0;
    };
    std::array<Run, 1024> runs_; // a ring
    uint64_t end_ = 0, next_ = 0, seen_ = 0;
    Within within_;                                                        // part of runs_[next_] before the cursor
    LargeArray<std::byte> bytes_ = LargeArray<std::byte>::make(kMaxBytes); // a ring
    uint64_t bytesEnd_ = 0;
};

} // namespace mural::delta
