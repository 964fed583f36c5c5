// Selects the readback of a window's pictures: synchronous, or into a buffer that another thread maps. The criterion is
// the time that the drawing thread loses: almost nothing with a buffer on asynchronous drivers, but a copy more on
// drivers that execute in the calling thread. Pure: times are arguments.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "nodes/gl/software_renderer.hpp"
#include "nodes/session/readback.hpp"

namespace mural {

// Replaces Auto by Direct for software drivers. They draw and copy in the calling thread, so a second thread saves
// nothing. It is also unsafe: in Mesa up to at least 22, llvmpipe reads the drawing of all contexts without a lock when
// it maps a buffer, and sometimes crashes.
[[nodiscard]] inline Readback readbackBy(std::string_view renderer, Readback requested) {
    return requested == Readback::Auto && gl::drawsWithoutGpu(renderer) ? Readback::Direct : requested;
}

class ReadbackChoice {
public:
    // Whether the next frame uses the buffer.
    [[nodiscard]] bool later() const { return frames_ < kMeasured ? frames_ % 2 == 1 : later_; }
    // Reports how long the drawing thread was blocked after a frame's last command.
    void took(int64_t ns) {
        if (frames_ >= kWarmUp && frames_ < kMeasured)
            (later() ? laterNs_ : atOnceNs_)[static_cast<size_t>(frames_ - kWarmUp) / 2] = ns;
        // similar times favour the simpler method
        if (++frames_ == kMeasured) later_ = 4 * median(laterNs_) < 3 * median(atOnceNs_);
        if (frames_ == kMeasured + kDecisionFrames) frames_ = kWarmUp;
    }

private:
    static constexpr int kWarmUp = 4, kSamples = 5, kMeasured = kWarmUp + 2 * kSamples;
    static constexpr int kDecisionFrames =
        2000; // frames until the next measurement, because the program's load changes
    static int64_t median(std::array<int64_t, kSamples> times) {
        std::ranges::sort(times);
        return times[kSamples / 2];
    }

    int frames_ = 0;
    bool later_ = false;
    std::array<int64_t, kSamples> atOnceNs_{}, laterNs_{};
};

} // namespace mural
