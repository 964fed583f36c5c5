// How a window's pictures leave GL: read at once, or written into a buffer that another thread waits for. By what the drawing thread loses: where drivers draw and copy
// by themselves the second is almost nothing, where they do it in the calling thread it is as much and a buffer besides. Pure: times are told.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "nodes/gl/software_renderer.hpp"
#include "nodes/session/readback.hpp"

namespace mural {

// Where the processor draws there is nothing to choose: drivers draw and copy in the thread that asks, so that another thread saves
// nothing. Nor is one harmless: to map a buffer, llvmpipe up to Mesa 22 at least looks through what all contexts draw, those that
// other threads use as well, without a lock, and at times ends the process.
[[nodiscard]] inline Readback readbackBy(std::string_view renderer, Readback wished) { return wished == Readback::Auto && gl::drawsWithoutGpu(renderer) ? Readback::Direct : wished; }

class ReadbackChoice {
public:
    // Of the next frame.
    [[nodiscard]] bool later() const { return frames_ < kMeasured ? frames_ % 2 == 1 : later_; }
    // The drawing thread took so long from a frame's last command until it could go on.
    void took(int64_t ns) {
        if (frames_ >= kWarmUp && frames_ < kMeasured) (later() ? laterNs_ : atOnceNs_)[static_cast<size_t>(frames_ - kWarmUp) / 2] = ns;
        if (++frames_ == kMeasured) later_ = 4 * median(laterNs_) < 3 * median(atOnceNs_); // what is about as good stays simple
        if (frames_ == kMeasured + kKept) frames_ = kWarmUp;
    }

private:
    static constexpr int kWarmUp = 4, kSamples = 5, kMeasured = kWarmUp + 2 * kSamples;
    static constexpr int kKept = 2000; // frames, until it is measured again: what a program draws becomes another
    static int64_t median(std::array<int64_t, kSamples> times) {
        std::ranges::sort(times);
        return times[kSamples / 2];
    }

    int frames_ = 0;
    bool later_ = false;
    std::array<int64_t, kSamples> atOnceNs_{}, laterNs_{};
};

} // namespace mural
