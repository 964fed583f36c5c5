// Whether small state that is as it was is left out. Where it comes in another order each time, that is the smaller stream; where frames
// are alike, they are equal runs already, and looking at each set costs more than it wins. So at first it is not; then by what frames
// cost with it and without, one after the other. No clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::holding {

class SmallChoice {
public:
    [[nodiscard]] bool leavesOut() const { return leavesOut_; }
    // The time of the next frame must be known.
    [[nodiscard]] bool wantsTime() const;
    // A frame has gone so. costNs: of its wireBytes on the link, and the time they took; below 0: not known.
    void frame(uint64_t programBytes, uint64_t wireBytes, double costNs);
    // Something else has changed what frames cost: what is being compared is no longer alike.
    void disturbed();

private:
    static constexpr uint32_t kCompared = 9; // frames by either way
    static constexpr uint32_t kHopeless = 3; // of a try, when each of them costs clearly more
    static constexpr uint32_t kSettling = 5; // and between them: what was remembered is of the other way
    static constexpr uint32_t kFirst = 64, kAfterChange = 64, kMostBetween = 4096;
    enum class Phase : uint8_t { Waiting, Before, Settling, Trying };

    void next(Phase phase);
    [[nodiscard]] bool hopeless() const;
    void decide();

    bool leavesOut_ = false;
    Phase phase_ = Phase::Waiting;
    uint32_t frames_ = 0; // of the phase
    uint32_t until_ = kFirst;
    uint32_t large_ = 0; // of those that were waited for, from which something can be won
    std::array<std::array<double, kCompared>, 2> costs_{}; // per byte of the program, before and while it is tried
};

} // namespace mural::holding
