// How fast a writer may send: a bucket of tokens that the members' losses fill slower or faster.
//
// Losses are of two kinds. A crowded link loses more the faster we send; a bad one loses its share at any rate, and
// sending slower would only be slower. Which it is shows an experiment: now and then, while there are losses, the rate
// is lowered for a moment. The share lost then is the floor; only what is lost above it counts as crowding.
// Increase and decrease: thesis, section "Reliable Stream Protocol" (additive; at most a fifth at once).
#pragma once

#include <cstdint>

namespace mural::rsp {

struct RateSettings {
    double mostBytesPerS = 0; // with all headers down to the wire; 0: no limit but the window
    double leastShare = 1.0 / 64;
};

class RateControl {
public:
    explicit RateControl(const RateSettings& settings);

    // Of so many datagrams of one round, the member that lost most lost this share of 1. Few datagrams prove little: what
    // may be chance is not taken for crowding.
    void roundEnded(double lostShare, int64_t datagrams, int64_t nowNs);
    // Rounds are as long as it takes for losses to be told, and to be more than chance.
    [[nodiscard]] static int64_t roundNs(int64_t roundTripNs);

    // Whether a datagram of so many bytes may go now; then its tokens are taken.
    bool take(double bytes, int64_t nowNs);
    // Whether so many may go now, or as many as may ever go at once.
    bool has(double bytes, int64_t nowNs);
    void giveBack(double bytes) { tokens_ += bytes; }
    // When so many bytes may go. INT64_MAX never occurs.
    [[nodiscard]] int64_t whenNs(double bytes, int64_t nowNs) const;
    // How much is worth waking up for: every wake costs at all ends, and so do datagrams that come one by one.
    [[nodiscard]] double batchBytes() const;

    [[nodiscard]] bool limited() const { return most_ > 0; }
    [[nodiscard]] double bytesPerS() const;
    [[nodiscard]] double lossFloor() const { return floor_; }

private:
    void refill(int64_t nowNs);
    void decideAfterTrial(double lostShare, int64_t nowNs);
    void rise(int64_t elapsedNs);

    static constexpr double kTrialRate = 0.85; // of the rate, during an experiment
    static constexpr int64_t kBetweenTrialsNs = 2'000'000'000;
    static constexpr int kTrialRounds = 3; // the first one still tells of the rate before

    double most_;
    double least_;
    double rate_;
    double tokens_ = 0;
    double depth_;
    int64_t refilledNs_ = INT64_MIN;
    int64_t roundNs_ = INT64_MIN; // when the last one ended
    double floor_ = 0;
    int trialRoundsLeft_ = 0;
    int64_t nextTrialNs_ = INT64_MIN;
};

} // namespace mural::rsp
