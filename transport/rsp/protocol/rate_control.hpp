// Rate of a writer: a token bucket whose fill rate depends on the members' losses.
//
// A congested link loses more at higher rates. A bad link loses a constant share, and a lower rate would gain nothing.
// An experiment distinguishes them: while there are losses, the rate is lowered for a moment at intervals. The
// remaining loss is the floor; only loss above it counts as congestion. Increase and decrease: thesis, section
// "Reliable Stream Protocol" (additive; at most a fifth at once).
#pragma once

#include <cstdint>

namespace mural::rsp {

struct RateSettings {
    double maxBytesPerS = 0; // including all headers; 0: limited by the window only
    double minShare = 1.0 / 64;
};

class RateControl {
public:
    explicit RateControl(const RateSettings& settings);

    // Reports a round: the largest loss of a member as a fraction, and the number of datagrams. Losses within random
    // variation are not congestion.
    void roundEnded(double lostShare, int64_t datagrams, int64_t nowNs);
    // Returns the length of a round: long enough for feedback and for statistical significance.
    [[nodiscard]] static int64_t roundNs(int64_t roundTripNs);

    // Returns true and consumes tokens if a datagram of this size may be sent now.
    bool take(double bytes, int64_t nowNs);
    // Returns true if this number of bytes, or a full bucket, may be sent now.
    bool has(double bytes, int64_t nowNs);
    void giveBack(double bytes) { tokens_ += bytes; }
    // Returns the time at which this number of bytes may be sent; never INT64_MAX.
    [[nodiscard]] int64_t whenNs(double bytes, int64_t nowNs) const;
    // Returns the number of bytes that justifies a wake-up: each costs CPU at all ends, as do single datagrams.
    [[nodiscard]] double batchBytes() const;

    [[nodiscard]] bool limited() const { return max_ > 0; }
    [[nodiscard]] double bytesPerS() const;
    [[nodiscard]] double lossFloor() const { return floor_; }

private:
    void refill(int64_t nowNs);
    void decideAfterTrial(double lostShare, int64_t nowNs);
    void rise(int64_t elapsedNs);

    static constexpr double kTrialRate = 0.85; // fraction of the rate during an experiment
    static constexpr int64_t kBetweenTrialsNs = 2'000'000'000;
    static constexpr int kTrialRounds = 3; // the first round still reflects the previous rate

    double max_;
    double min_;
    double rate_;
    double tokens_ = 0;
    double depth_;
    int64_t refilledNs_ = INT64_MIN;
    int64_t roundNs_ = INT64_MIN; // end of the last round
    double floor_ = 0;
    int trialRoundsLeft_ = 0;
    int64_t nextTrialNs_ = INT64_MIN;
};

} // namespace mural::rsp
