// Runs of short records of late, with their bytes one behind the other: an equal frame is compared as such, and not record by record.
// Only the packer needs it. The bytes of items themselves lie about the ring, where each was new.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "economy/item_log.hpp"
#include "economy/large_array.hpp"

namespace mural::economy {

class KnownRuns {
public:
    static constexpr size_t kLeastItems = 16; // fewer are compared as quickly one by one

    struct Run {
        uint64_t position = 0; // of the first item in the log
        uint64_t bytesAt = 0;  // where its bytes are, counted from the first of all
        uint64_t oldestText = 0; // TextRing::written() when the oldest of its items was
        uint32_t items = 0, sizeBytes = 0;
    };

    // In the order of positions.
    void add(const Run& run) { runs_[end_++ % runs_.size()] = run; }
    // Its bytes, too; where they are. `bytes`: at most kMostBytes.
    uint64_t keep(std::span<const std::byte> bytes) {
        if (const uint64_t at = bytesEnd_ % kMostBytes; at + bytes.size() > kMostBytes) bytesEnd_ += kMostBytes - at;
        std::memcpy(bytes_.data() + bytesEnd_ % kMostBytes, bytes.data(), bytes.size());
        bytesEnd_ += bytes.size();
        return bytesEnd_ - bytes.size();
    }

    // What is known from the log's cursor on; `items` 0: nothing. Quick where the cursor moves forward.
    [[nodiscard]] Run fromCursor(const ItemLog& log) {
        const auto at = [this](uint64_t i) -> const Run& { return runs_[i % runs_.size()]; };
        const uint64_t position = log.cursor;
        const auto behind = [&](uint64_t i) { return at(i).position + at(i).items > position; };
        if (position < seen_ || end_ - next_ > runs_.size() || (end_ - next_ > kMostSteps && !behind(next_ + kMostSteps))) {
            uint64_t first = end_ < runs_.size() ? 0 : end_ - runs_.size();
            for (uint64_t last = end_; first < last;) { // the first that is behind it
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
        if (run.bytesAt + kMostBytes < bytesEnd_ || !log.holds(run.position)) return {};
        for (; run.position + within_.items < position; ++within_.items) within_.sizeBytes += log.at(run.position + within_.items).sizeBytes;
        return {position, run.bytesAt + within_.sizeBytes, run.oldestText, run.items - within_.items, run.sizeBytes - within_.sizeBytes};
    }
    [[nodiscard]] const std::byte* bytesOf(const Run& run) const { return bytes_.data() + run.bytesAt % kMostBytes; }

    static constexpr size_t kMostBytes = size_t{4} << 20;

private:
    static constexpr uint64_t kMostSteps = 4; // farther ones are searched for
    struct Within {
        uint32_t items = 0, sizeBytes = 0;
    };
    std::array<Run, 1024> runs_; // a ring
    uint64_t end_ = 0, next_ = 0, seen_ = 0;
    Within within_; // of runs_[next_]: so much is before the cursor
    LargeArray<std::byte> bytes_ = LargeArray<std::byte>::make(kMostBytes); // a ring
    uint64_t bytesEnd_ = 0;
};

} // namespace mural::economy
