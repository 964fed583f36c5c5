// One member's reading end of one writer's stream: puts the bytes in order, and tells the writer what it has, what it
// lacks and how much it may be sent. Without sockets, clock or threads, as Sender.
//
// Told is: every so many datagrams (at another one in each member), at a poll, when something is lost, while that is not
// mended, when there is room again for a writer that may wait for it, and as a heartbeat.
#pragma once

#include "transport/rsp/gap_watch.hpp"
#include "transport/rsp/outbox.hpp"
#include "transport/rsp/receive_window.hpp"

namespace mural::rsp {

struct ReceiverSettings {
    StreamShape shape; // as the writer's
    MemberId self = 0;
    MemberId writer = 0;
    uint32_t socketDatagrams = 4096; // that the socket's buffer holds while this process does not run
    int64_t heartbeatNs = 100'000'000;
};

class Receiver {
public:
    Receiver(const ReceiverSettings& settings, Sequence first);

    // Where what comes next is wanted; what comes elsewhere is taken as well.
    Landing landing() { return window_.landing(); }
    void input(const StreamDatagram& d, int64_t nowNs);
    // The socket has dropped so many datagrams since it was opened.
    void socketDropped(uint32_t count) { dropped_ = count; }

    [[nodiscard]] std::span<const std::byte> readable() const { return window_.readable(); }
    size_t readable(std::span<std::span<const std::byte>> into) const { return window_.readable(into); }
    void consume(size_t bytes) { window_.consume(bytes); }
    // What was consumed may be worth telling.
    [[nodiscard]] bool hasNews() const { return tellNow_ || roomIsNews(); }

    // Sends what is to be told; returns when to come again at the latest. Call it after input, and when there is news, too.
    int64_t tick(int64_t nowNs, Outbox& out);

    [[nodiscard]] Sequence cumulative() const { return window_.cumulative(); }
    [[nodiscard]] const ReceiveCounters& counters() const { return window_.counters(); }
    [[nodiscard]] uint64_t feedbackSent() const { return feedbackSent_; }
    [[nodiscard]] uint32_t lost() const { return lost_; }
    [[nodiscard]] int64_t latenessNs() const { return gaps_.latenessNs(); }

private:
    [[nodiscard]] Sequence edgeNow() const;
    [[nodiscard]] bool anyLost() const { return window_.cumulative() < gaps_.lostBefore(); }
    [[nodiscard]] bool roomIsNews() const;
    [[nodiscard]] int64_t dueNs() const;
    void polled(Sequence next);
    void countLost(Sequence before);
    void tell(int64_t nowNs, Outbox& out);

    ReceiverSettings settings_;
    ReceiveWindow window_;
    GapWatch gaps_;
    uint32_t ackEvery_;
    uint32_t sinceAck_;       // datagrams
    Sequence toldEdge_;
    Sequence countedLost_;
    uint32_t lost_ = 0;
    uint32_t dropped_ = 0;
    uint32_t newestUs_ = 0;   // time of sending of the newest datagram
    int64_t newestNs_ = 0;    // when it came
    int64_t toldNs_ = INT64_MIN;
    int64_t repairNs_;        // how long a repair takes to come
    int64_t askedNs_ = INT64_MIN;
    bool tellNow_ = true;     // the first feedback: the writer learns our edge
    bool newlyLost_ = false;
    uint64_t feedbackSent_ = 0;
};

} // namespace mural::rsp
