// A member's receiving end of one writer's stream: restores the order, and sends feedback about received and missing
// data and its window. Has no sockets, clock or threads, as Sender.
//
// Feedback is sent
// - every N datagrams, with a different phase per member,
// - after a POLL,
// - after a loss, and until its repair,
// - when a waiting writer gains room,
// - as heartbeat.
#pragma once

#include "transport/rsp/protocol/loss_detector.hpp"
#include "transport/rsp/wire/datagram_sink.hpp"
#include "transport/rsp/protocol/receive_window.hpp"

namespace mural::rsp {

struct ReceiverSettings {
    StreamShape shape; // equal to the writer's
    MemberId self = 0;
    MemberId writer = 0;
    uint32_t socketDatagrams = 4096; // capacity of the socket buffer while this process does not run
    int64_t heartbeatNs = 100'000'000;
};

class Receiver {
public:
    Receiver(const ReceiverSettings& settings, Sequence first);

    // Buffers for the next datagrams. Datagrams received elsewhere are accepted as well.
    ReceiveBuffers landing() { return window_.landing(); }
    void input(const StreamDatagram& d, int64_t nowNs);
    // Sets the total number of datagrams that the socket has dropped.
    void socketDropped(uint32_t count) { dropped_ = count; }

    [[nodiscard]] std::span<const std::byte> readable() const { return window_.readable(); }
    size_t readable(std::span<std::span<const std::byte>> into) const { return window_.readable(into); }
    void consume(size_t bytes) { window_.consume(bytes); }
    // Returns true if feedback is due after consumption.
    [[nodiscard]] bool hasUnreported() const { return reportNow_ || spaceIsUnreported(); }

    // Sends due feedback and returns the time of the next call. Call it also after input, and when hasUnreported() is
    // true.
    int64_t tick(int64_t nowNs, DatagramSink& out);

    [[nodiscard]] Sequence cumulative() const { return window_.cumulative(); }
    [[nodiscard]] const ReceiveCounters& counters() const { return window_.counters(); }
    [[nodiscard]] uint64_t feedbackSent() const { return feedbackSent_; }
    [[nodiscard]] uint32_t lost() const { return lost_; }
    [[nodiscard]] int64_t latenessNs() const { return gaps_.latenessNs(); }

private:
    [[nodiscard]] Sequence edgeNow() const;
    [[nodiscard]] bool anyLost() const { return window_.cumulative() < gaps_.lostBefore(); }
    [[nodiscard]] bool spaceIsUnreported() const;
    [[nodiscard]] int64_t dueNs() const;
    void polled(Sequence next);
    void countLost(Sequence before);
    void sendFeedback(int64_t nowNs, DatagramSink& out);

    ReceiverSettings settings_;
    ReceiveWindow window_;
    LossDetector gaps_;
    uint32_t ackEvery_;
    uint32_t sinceAck_; // in datagrams
    Sequence reportedEdge_;
    Sequence countedLost_;
    uint32_t lost_ = 0;
    uint32_t dropped_ = 0;
    uint32_t newestUs_ = 0; // send time of the newest datagram
    int64_t newestNs_ = 0;  // its arrival time
    int64_t publishedNs_ = INT64_MIN;
    int64_t repairNs_; // expected delay of a repair
    int64_t requestedNs_ = INT64_MIN;
    bool reportNow_ = true; // the first feedback advertises the window
    bool newlyLost_ = false;
    uint64_t feedbackSent_ = 0;
};

} // namespace mural::rsp
