// How long who waits for a stream may leave its datagrams to gather, before it looks at the sockets again: to be woken for
// each few is most of what receiving costs. What wards off wakes delays as well, so the end of a flush, which asks for an
// answer at once, ends it; and what is in full flow is not held up by more than an eighth of the time that it has flowed.
//
// The same is done by network cards, as interrupt moderation. Without clock or threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace mural::rsp {

class ReceiveModeration {
public:
    // A look at the sockets found so many datagrams; `urgent`: somebody waits for what comes of one of them.
    void looked(size_t datagrams, bool urgent, int64_t nowNs) {
        if (urgent || (datagrams > 0 && nowNs - foundNs_ > kMostSilenceNs)) beganNs_ = nowNs;
        if (datagrams > 0) foundNs_ = nowNs;
    }

    // How long from now on nobody need look; 0: at once.
    [[nodiscard]] int64_t restNs(int64_t nowNs) const {
        const int64_t restNs = std::min((nowNs - beganNs_) / kShareOfFlow, kMostRestNs);
        return restNs < kLeastRestNs || nowNs - foundNs_ > kMostSilenceNs ? 0 : restNs;
    }

    static constexpr int64_t kMostRestNs = 1'000'000;  // a socket of 8 MiB holds what comes meanwhile at 50 Gbit/s
    static constexpr int64_t kLeastRestNs = 60'000;    // a timer is as late as that
    static constexpr int64_t kShareOfFlow = 8;
    static constexpr int64_t kMostSilenceNs = 3'000'000; // the flow is over

private:
    int64_t beganNs_ = INT64_MIN / 2; // the flow
    int64_t foundNs_ = INT64_MIN / 2; // the last datagrams
};

} // namespace mural::rsp
