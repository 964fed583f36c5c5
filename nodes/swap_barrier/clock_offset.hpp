// How another machine's clock stands against this one's, from messages that go there and come back (RFC 5905, section 8).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mural {

struct ClockSample {
    int64_t sentNs = 0;         // here
    int64_t arrivedThereNs = 0; // by the other clock
    int64_t leftThereNs = 0;
    int64_t cameBackNs = 0; // here
};

class ClockOffset {
public:
    void add(const ClockSample& sample);
    // What the other clock shows more than this one: of the last samples the one that was on its way for the shortest time.
    [[nodiscard]] int64_t offsetNs() const { return best_.offsetNs; }
    // It is not further off: half of the time on the way. INT64_MAX: no sample yet.
    [[nodiscard]] int64_t errorNs() const { return best_.wayNs == INT64_MAX ? INT64_MAX : (best_.wayNs + 1) / 2; }

private:
    struct Seen {
        int64_t offsetNs = 0;
        int64_t wayNs = INT64_MAX;
    };
    static constexpr size_t kKept = 64; // clocks drift by up to 100 us a second against each other
    std::array<Seen, kKept> seen_;
    size_t next_ = 0;
    Seen best_;
};

} // namespace mural
