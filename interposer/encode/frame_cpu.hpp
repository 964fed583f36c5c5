// CPU time per frame of a thread that shows frames. Its excess over a run without Mural is the overhead of capture.
#pragma once

#include <cstdint>

#include "common/base/clock.hpp"

namespace mural {

// One per thread. Queries the kernel every 16th frame only, because a query takes a few microseconds.
class FrameCpu {
public:
    static constexpr uint32_t kFrames = 16;

    static constexpr uint32_t kWarmFrames = 2 * kFrames; // start-up frames of a thread, not counted

    // Call after each frame. Returns the CPU time in ns of the last kFrames frames, or 0 between measurements.
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
