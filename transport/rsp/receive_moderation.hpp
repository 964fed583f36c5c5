// How long who waits for a stream may leave its datagrams to gather, before it looks at the sockets again: to be woken for
// each few is most of what receiving costs. What wards off wakes delays as well, so the end of a flush, which asks for an
// answer at once, ends it; and what is in full flow is not held up by more than an eighth of the time that it has flowed.
// A look that left something behind is followed by the next one at once: a look has a bound, and a flow none. And no more
// gathers, as far as the flow so far tells, than a part of what the socket holds.
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
    // How long from now on nobody need look; 0: at once.
    [[nodiscard]] int64_t restNs(int64_t nowNs) const {
        if (mayBeMore_) return 0;
        const int64_t fillsNs = std::min(betweenNs_, kMostRestNs) * (roomDatagrams_ / kShareOfSocket); // that part of the socket
        const int64_t restNs = std::min({(nowNs - beganNs_) / kShareOfFlow, fillsNs, kMostRestNs});
        return restNs < kLeastRestNs || nowNs - foundNs_ > kMostSilenceNs ? 0 : restNs;
    }

    static constexpr int64_t kMostRestNs = 4'000'000;
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
