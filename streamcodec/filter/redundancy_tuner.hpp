// Decides whether redundant state setters are dropped. Dropping them gives a smaller stream if their order varies. In
// repeating frames they are part of equal runs, and examining each setter costs more than it saves. So filtering is
// initially off, and then selected by the cost of frames with and without it. Has no clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::filter {

class RedundancyTuner {
public:
    [[nodiscard]] bool dropsRedundant() const { return drops_; }
    // Returns true if the next frame must be timed.
    [[nodiscard]] bool wantsTime() const;
    // Reports a frame. costNs: transfer time of wireBytes plus CPU time; negative: unknown.
    void frame(uint64_t programBytes, uint64_t wireBytes, double costNs);
    // Another change affects the cost of frames: restarts the comparison.
    void disturbed();

private:
    static constexpr uint32_t kCompared = 9; // frames per alternative
    static constexpr uint32_t kHopeless = 3; // frames after which a clearly worse trial ends
    static constexpr uint32_t kSettling = 5; // frames between alternatives, whose dictionary state is outdated
    static constexpr uint32_t kFirst = 64, kAfterChange = 64, kMaxBetween = 4096;
    enum class Phase : uint8_t { Waiting, Before, Settling, Trying };

    void next(Phase phase);
    [[nodiscard]] bool hopeless() const;
    void decide();

    bool drops_ = false;
    Phase phase_ = Phase::Waiting;
    uint32_t frames_ = 0; // in this phase
    uint32_t until_ = kFirst;
    uint32_t large_ = 0;                                   // relevant frames in the waiting phase
    std::array<std::array<double, kCompared>, 2> costs_{}; // per byte of the program, before and during the trial
};

} // namespace mural::filter
