// When a missing datagram counts as lost. One that is merely late overtakes few others and comes soon: so a gap is lost
// when three later datagrams have come and it is older than the network is seen to be late; or when the writer polls,
// who has nothing more to send.
#pragma once

#include <cstdint>
#include <deque>

#include "transport/rsp/sequence.hpp"

namespace mural::rsp {

class GapWatch {
public:
    explicit GapWatch(Sequence first) : highest_(first), lostBefore_(first) {}

    // A datagram came that was sent for the first time.
    void arrived(Sequence s, int64_t nowNs);
    // It had been given up, and came `lateNs` after others that were sent with it.
    void cameLate(int64_t lateNs);
    // All before `next` were sent.
    void polled(Sequence next);
    // Gives up what is old enough; returns whether anything was.
    bool look(int64_t nowNs);

    [[nodiscard]] Sequence highest() const { return highest_; }       // behind the newest that is known of
    [[nodiscard]] Sequence lostBefore() const { return lostBefore_; } // what is missing before it is lost
    // When the oldest gap may be given up; INT64_MAX: there is none.
    [[nodiscard]] int64_t whenNs() const;
    [[nodiscard]] int64_t latenessNs() const { return latenessNs_; }

private:
    struct Gap {
        Sequence end;
        int64_t noticedNs;
    };
    static constexpr int kLater = 3;
    static constexpr int64_t kMostLatenessNs = 5'000'000;

    std::deque<Gap> gaps_;
    Sequence highest_;
    Sequence lostBefore_;
    int64_t latenessNs_ = 0;
};

} // namespace mural::rsp
