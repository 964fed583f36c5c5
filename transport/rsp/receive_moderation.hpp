// How long who waits for a stream may leave its datagrams to gather, before it looks at the sockets again: to be woken for
// each few is most of what receiving costs. What wards off wakes delays as well, so the end of a flush, which asks for an
// answer at once, ends it; and what is in full flow is not held up by more than an eighth of the time that it has flowed.
// A look that left something behind is followed by the next one at once: a look has a bound, and a flow none. And no more
// gathers, as far as the flow so far tells, than a part of what the socket holds.
//
// In full flow each member looks when it is its turn, at times of its own: where several run on one machine they would else
// happen to look at once, now and then for seconds, and keep all its cores from whoever sends there.
//
// The same is done by network cards, as interrupt moderation. Without clock or threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace mural::rsp {

class ReceiveModeration {
public:
    // Datagrams that the socket holds while nobody looks.
    explicit ReceiveModeration(uint32_t socketDatagrams) : roomDatagrams_(socketDatagrams) {}

    struct Look {
        size_t datagrams = 0;
        bool urgent = false;    // somebody waits for what comes of one of them
        bool mayBeMore = false; // it took as many as a look may
    };

    void looked(const Look& look, int64_t nowNs) {
        const auto& [datagrams, urgent, mayBeMore] = look;
        mayBeMore_ = mayBeMore;
        if (urgent || (datagrams > 0 && nowNs - foundNs_ > kMostSilenceNs)) beganNs_ = nowNs;
        if (datagrams > 0) foundNs_ = nowNs;
        gathered_ += datagrams;
        if (mayBeMore) return;
        // All of what came since the last time that nothing was left.
        if (gathered_ > 0) betweenNs_ = (nowNs - emptiedNs_) / static_cast<int64_t>(gathered_);
        emptiedNs_ = nowNs;
        gathered_ = 0;
    }

    [[nodiscard]] bool mayBeMore() const { return mayBeMore_; }
    // How long from now on nobody need look, in this member; 0: at once.
    [[nodiscard]] int64_t restNs(int64_t nowNs, uint32_t member) const {
        if (mayBeMore_) return 0;
        const int64_t fillsNs = std::min(betweenNs_, kMostRestNs) * (roomDatagrams_ / kShareOfSocket); // that part of the socket
        const int64_t restNs = std::min({(nowNs - beganNs_) / kShareOfFlow, fillsNs, kMostRestNs});
        if (restNs < kLeastRestNs || nowNs - foundNs_ > kMostSilenceNs) return 0;
        return std::min(restNs, untilTurnNs(nowNs, member));
    }

    // Till its next turn that is not just now. Turns are spread by the golden section: any few members that follow each other are far apart.
    [[nodiscard]] static int64_t untilTurnNs(int64_t nowNs, uint32_t member) {
        constexpr uint32_t kGoldenSection = 0x9e3779b9; // of 2^32
        const int64_t ownNs = static_cast<int64_t>(uint64_t{member * kGoldenSection} * kBetweenTurnsNs >> 32);
        const int64_t leftNs = kBetweenTurnsNs - (nowNs - ownNs) % kBetweenTurnsNs;
        return leftNs < kLeastToTurnNs ? leftNs + kBetweenTurnsNs : leftNs;
    }

    static constexpr int64_t kBetweenTurnsNs = 4'000'000;
    static constexpr int64_t kLeastToTurnNs = kBetweenTurnsNs / 4;
    static constexpr int64_t kMostRestNs = kBetweenTurnsNs + kLeastToTurnNs;
    static constexpr int64_t kLeastRestNs = 60'000;    // a timer is as late as that
    static constexpr int64_t kShareOfFlow = 8;
    static constexpr uint32_t kShareOfSocket = 4;
    static constexpr int64_t kMostSilenceNs = 10'000'000; // the flow is over; of a busy machine a writer, or who reads, may be late by less

private:
    int64_t beganNs_ = INT64_MIN / 2; // the flow
    int64_t foundNs_ = INT64_MIN / 2; // the last datagrams
    int64_t emptiedNs_ = INT64_MIN / 2; // nothing was left
    uint64_t gathered_ = 0;             // datagrams since then
    int64_t betweenNs_ = kMostRestNs;   // two datagrams, by the last ones that gathered
    uint32_t roomDatagrams_;
    bool mayBeMore_ = false;
};

} // namespace mural::rsp
