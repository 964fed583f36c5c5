// Loss detection. Few datagrams overtake a late one, and it arrives soon. A gap therefore counts as lost in two cases:
// - three later datagrams have arrived, and the gap is older than the observed reordering delay;
// - the writer polls, because it has nothing more to send.
#pragma once

#include <cstdint>
#include <deque>

#include "transport/rsp/wire/sequence.hpp"

namespace mural::rsp {

class LossDetector {
public:
    explicit LossDetector(Sequence first) : highest_(first), lostBefore_(first) {}

    // Reports the arrival of a datagram that is not a retransmission.
    void arrived(Sequence s, int64_t nowNs);
    // Reports a datagram that arrived after it had been declared lost, `lateNs` after its contemporaries.
    void onLateArrival(int64_t lateNs);
    // Everything before `next` has been sent.
    void polled(Sequence next);
    // Declares expired gaps lost. Returns true if there are any.
    bool expire(int64_t nowNs);

    [[nodiscard]] Sequence highest() const { return highest_; }       // one past the newest known sequence number
    [[nodiscard]] Sequence lostBefore() const { return lostBefore_; } // missing datagrams before it are lost
    // Expiry of the oldest gap; INT64_MAX: none.
    [[nodiscard]] int64_t whenNs() const;
    [[nodiscard]] int64_t latenessNs() const { return latenessNs_; }

private:
    struct Gap {
        Sequence end;
        int64_t noticedNs;
    };
    static constexpr int kLater = 3;
    static constexpr int64_t kMaxLatenessNs = 5'000'000;

    std::deque<Gap> gaps_;
    Sequence highest_;
    Sequence lostBefore_;
    int64_t latenessNs_ = 0;
};

} // namespace mural::rsp
