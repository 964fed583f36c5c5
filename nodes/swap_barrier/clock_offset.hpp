// Estimates the offset of another machine's clock from round trips (RFC 5905, section 8).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mural {

struct ClockSample {
    int64_t sentNs = 0;         // local clock
    int64_t arrivedThereNs = 0; // remote clock
    int64_t leftThereNs = 0;
    int64_t cameBackNs = 0; // local clock
};

class ClockOffset {
public:
    void add(const ClockSample& sample);
    // Remote minus local clock, from the recent sample with the shortest round trip.
    [[nodiscard]] int64_t offsetNs() const { return best_.offsetNs; }
    // Upper bound of the error: half of the round trip. INT64_MAX: no sample yet.
    [[nodiscard]] int64_t errorNs() const { return best_.wayNs == INT64_MAX ? INT64_MAX : (best_.wayNs + 1) / 2; }

private:
    struct Seen {
        int64_t offsetNs = 0;
        int64_t wayNs = INT64_MAX;
    };
    static constexpr size_t kSamples = 64; // recent samples only: clocks drift by up to 100 us per second
    std::array<Seen, kSamples> seen_;
    size_t next_ = 0;
    Seen best_;
};

} // namespace mural
