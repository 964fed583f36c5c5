// Decides for how long a waiting reader may let datagrams accumulate before it reads the sockets again. Wake-ups per
// few datagrams dominate the cost of receiving.
//
// Moderation adds latency, so a datagram that requests immediate feedback (the end of a flush) stops it, and a flow is
// delayed by at most an eighth of its age. A read that leaves datagrams behind is followed by the next one immediately.
// Not more than a fraction of the socket's capacity accumulates, as estimated from the flow so far.
//
// Network cards do the same as interrupt moderation. Has no clock or threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace mural::rsp {

class ReceiveModeration {
public:
    // Capacity of the socket in datagrams.
    explicit ReceiveModeration(uint32_t socketDatagrams) : roomDatagrams_(socketDatagrams) {}

    struct PollResult {
        size_t datagrams = 0;
        bool urgent = false;    // one of them must be processed immediately
        bool mayBeMore = false; // the read reached its limit
    };

    void onPolled(const PollResult& result, int64_t nowNs) {
        const auto& [datagrams, urgent, mayBeMore] = result;
        mayBeMore_ = mayBeMore;
        if (urgent || (datagrams > 0 && nowNs - foundNs_ > kMaxSilenceNs)) beganNs_ = nowNs;
        if (datagrams > 0) foundNs_ = nowNs;
        gathered_ += datagrams;
        if (mayBeMore) return;
        // Mean interval of all datagrams since the socket was last empty.
        if (gathered_ > 0) betweenNs_ = (nowNs - emptiedNs_) / static_cast<int64_t>(gathered_);
        emptiedNs_ = nowNs;
        gathered_ = 0;
    }

    [[nodiscard]] bool mayBeMore() const { return mayBeMore_; }
    // Returns the time until the next read; 0: immediately.
    [[nodiscard]] int64_t restNs(int64_t nowNs) const {
        if (mayBeMore_) return 0;
        // time to fill that fraction of the socket
        const int64_t fillsNs = std::min(betweenNs_, kMaxRestNs) * (roomDatagrams_ / kShareOfSocket);
        const int64_t restNs = std::min({(nowNs - beganNs_) / kShareOfFlow, fillsNs, kMaxRestNs});
        return restNs < kMinRestNs || nowNs - foundNs_ > kMaxSilenceNs ? 0 : restNs;
    }

    static constexpr int64_t kMaxRestNs = 4'000'000;
    static constexpr int64_t kMinRestNs = 60'000; // a timer's latency
    static constexpr int64_t kShareOfFlow = 8;
    static constexpr uint32_t kShareOfSocket = 4;
    // end of a flow; on a busy machine writers and readers may pause for less
    static constexpr int64_t kMaxSilenceNs = 10'000'000;

private:
    int64_t beganNs_ = INT64_MIN / 2;   // start of the flow
    int64_t foundNs_ = INT64_MIN / 2;   // last non-empty read
    int64_t emptiedNs_ = INT64_MIN / 2; // last time that the socket was empty
    uint64_t gathered_ = 0;             // datagrams since then
    int64_t betweenNs_ = kMaxRestNs;    // interval between two datagrams
    uint32_t roomDatagrams_;
    bool mayBeMore_ = false;
};

} // namespace mural::rsp
