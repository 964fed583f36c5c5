// Selects the slot (RawRunCache) in which to expect each run of plain records: the run of the previous frame with the
// same stream, size, and index among runs of this size. Caching a run copies it on both sides, so only runs that occur
// twice are cached. Encoder only.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "streamcodec/delta/dictionary/raw_run_cache.hpp"

namespace mural::delta {

class RawRunSlots {
public:
    enum class Advice : uint8_t { Nothing, Keep, Compare };
    struct SlotAdvice {
        uint32_t slot = 0;
        Advice advice = Advice::Nothing;
    };

    // Returns the slot for a run of this frame.
    [[nodiscard]] SlotAdvice expect(uint32_t stream, size_t sizeBytes, uint64_t frame) {
        if (sizeBytes < RawRunCache::kMinBytes || sizeBytes > RawRunCache::kMaxBytes || sizeBytes % 4 != 0) return {};
        const auto found = std::ranges::find_if(
            runs_, [&](const Run& r) { return r.sizeBytes == sizeBytes && r.stream == stream && r.frame != frame; });
        if (found == runs_.end()) {
            runs_[next_] = {stream, static_cast<uint32_t>(sizeBytes), frame};
            next_ = (next_ + 1) % RawRunCache::kSlots;
            return {};
        }
        Run& run = *found;
        run.frame = frame;
        const auto slot = static_cast<uint32_t>(found - runs_.begin());
        if (run.isCached) return {slot, Advice::Compare};
        if (run.wait > 0) {
            --run.wait;
            return {};
        }
        run.isCached = true;
        return {slot, Advice::Keep};
    }
    // Reports a comparison with the slot: few of its words have changed, or many.
    void changed(uint32_t slot, bool few) {
        Run& run = runs_[slot];
        run.isCached = few;
        run.patience = few ? 0 : std::min(run.patience * 2 + 1, kMaxPatience);
        run.wait = run.patience;
    }

private:
    static constexpr uint32_t kMaxPatience = 63;
    struct Run {
        uint32_t stream = 0, sizeBytes = 0;
        uint64_t frame = 0; // last frame with this run
        bool isCached = false;
        uint32_t patience = 0, wait = 0; // repetitions to skip before it is cached again, after useless caching
    };
    std::array<Run, RawRunCache::kSlots> runs_{};
    uint32_t next_ = 0; // slot of the next new run
};

} // namespace mural::delta
