// Flow control of one viewer's pictures: two pictures in flight, and quality by the times of the acknowledgements. A
// slow viewer receives fewer and smaller pictures and slows nobody else. Pure; not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace mural::page {

class ViewerFlow {
public:
    static constexpr size_t kMaxInFlight = 2;
    // JPEG qualities, the best first, relative to the page's limit.
    static constexpr std::array<int, 5> kQualities = {100, 85, 70, 60, 50};

    // Returns whether a picture may be sent now.
    [[nodiscard]] bool canSend() const { return inFlight_.size() < kMaxInFlight; }
    void sent(uint64_t frame, int64_t nowNs);
    // The viewer has shown a frame, and with it all that were sent before.
    void acknowledged(uint64_t frame, int64_t nowNs);
    // The class of the viewer's pictures changes, or it has left.
    void reset();

    // Quality in percent of the limit.
    [[nodiscard]] int quality() const { return kQualities[step_]; }
    [[nodiscard]] int64_t roundTripNs() const { return roundTripNs_; } // smoothed; 0: unknown

private:
    static constexpr int64_t kLateNs = 400'000'000, kInTimeNs = 200'000'000;
    static constexpr int64_t kDownAfterNs = 500'000'000, kUpAfterNs = 2'000'000'000;

    struct Sent {
        uint64_t frame = 0;
        int64_t atNs = 0;
    };
    std::deque<Sent> inFlight_;
    size_t step_ = 0;
    int64_t changedNs_ = 0; // the last change of the step
    int64_t roundTripNs_ = 0;
};

} // namespace mural::page
