// CPU time of a thread that shows frames, from frame to frame: what capture costs a program is the
// difference to a run without it.
#pragma once

#include <cstdint>

#include "common/clock.hpp"

namespace mural {

// One per thread. The kernel is asked every 16th frame only: the question takes a few microseconds.
class FrameCpu {
public:
    static constexpr uint32_t kFrames = 16;

    static constexpr uint32_t kWarmFrames = 2 * kFrames; // of a thread, and all before: start-up, not counted

    // After each frame. Not 0: ns of CPU time that the last kFrames frames took.
    uint64_t afterFrame() {
        if (++frames_ % kFrames != 0) return 0;
        const int64_t nowNs = threadCpuNowNs();
        const int64_t tookNs = frames_ <= kWarmFrames ? 0 : nowNs - atNs_;
        atNs_ = nowNs;
        return static_cast<uint64_t>(tookNs);
    }

private:
    uint32_t frames_ = 0;
    int64_t atNs_ = 0;
};

} // namespace mural
