// The state machine of a swap barrier: decides when members wait and when they are released. It has no clocks, threads
// or sockets: times are arguments.
//
// All members replay the same stream and reach the same swaps in the same order; some may skip swaps. A round ends when
// every member waits: the members with the oldest swap are released. A member that misses its deadline is ignored until
// it arrives again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "nodes/swap_barrier/swap_key.hpp"

namespace mural {

class BarrierRounds {
public:
    BarrierRounds(int members, int64_t patienceNs) : members_(static_cast<size_t>(members)), patienceNs_(patienceNs) {}

    struct Release {
        SwapKey key;
        std::vector<int> members;
    };
    struct Step {
        std::vector<Release> releases;
        std::vector<int> late; // ignored from now on
    };
    Step arrive(int member, const SwapKey& key, int64_t nowNs);
    Step gone(int member, int64_t nowNs); // the member has left permanently
    Step tick(int64_t nowNs);

    [[nodiscard]] bool isGone(int member) const { return members_[static_cast<size_t>(member)].state == State::Gone; }

private:
    enum class State { Away, Waiting, Late, Gone };
    struct Member {
        State state = State::Away;
        SwapKey key;
        uint64_t order = 0; // order of arrival
    };
    void releaseRounds(Step& step, int64_t nowNs);
    [[nodiscard]] bool passed(const SwapKey& key) const;

    std::vector<Member> members_;
    const int64_t patienceNs_;
    int64_t progressNs_ = 0; // time of the last arrival or release
    uint64_t arrivals_ = 0;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> passed_; // last released frame by client and window
};

} // namespace mural
