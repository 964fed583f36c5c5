// Sending end of one stream to a group: schedules datagrams and repairs losses. Has no sockets, clock or threads: times
// come in, datagrams go to a DatagramSink, and tick() returns the time of its next call.
//
// Source: thesis, section "Reliable Stream Protocol"; docs/architecture/transport.md lists the differences.
#pragma once

#include <map>
#include <vector>

#include "transport/rsp/wire/datagram_sink.hpp"
#include "transport/rsp/protocol/rate_control.hpp"
#include "transport/rsp/protocol/retransmit_planner.hpp"
#include "transport/rsp/protocol/send_window.hpp"

namespace mural::rsp {

struct SenderSettings {
    StreamShape shape;
    MemberId self = 0;
    RateSettings rate;
    size_t tagBytes = 0; // size of the tag per datagram, for the rate
    bool parity = true;  // false: repairs by retransmission only, for comparisons
    int64_t heartbeatNs = 100'000'000;
};

// The writer's view of a member.
struct MemberState {
    Sequence cumulative;
    Sequence edge;
    int64_t receivedNs = 0;  // last time that it is known to have received a datagram
    int64_t movedNs = 0;     // last progress of cumulative or edge, or last time without unacknowledged data
    int64_t roundTripNs = 0; // smoothed; 0: unknown
    int64_t roundTripVarNs = 0;
    uint32_t lost = 0;    // as reported
    uint32_t dropped = 0; // by its socket, as reported
    double lostShare = 0; // in the last round
};

struct SenderCounters {
    uint64_t bytes = 0; // payload, without retransmissions
    uint64_t datagrams = 0;
    uint64_t rows = 0;
    uint64_t rowsAhead = 0; // included in rows
    uint64_t resent = 0;
    uint64_t polls = 0;
    uint64_t feedback = 0;
    uint64_t refused = 0; // invalid feedback
};

class Sender {
public:
    Sender(const SenderSettings& settings, Sequence first);

    // Adds a member, which receives the stream from the returned sequence number on.
    Sequence addMember(MemberId id, int64_t nowNs);
    // Removes a member. The stream no longer waits for it.
    void removeMember(MemberId id);
    [[nodiscard]] const std::map<MemberId, MemberState>& members() const { return members_; }

    // Requests immediate feedback from all members.
    void requestFeedback() { pollNow_ = changed_ = true; }

    // Copies as much as there is room for; returns the number of bytes. Without members all data is accepted and
    // discarded.
    size_t write(std::span<const std::byte> bytes);
    // Bytes written since the start: the start position of a member added now.
    [[nodiscard]] uint64_t writtenBytes() const { return writtenBytes_; }
    // Sends buffered data now and requests an immediate acknowledgement.
    void flush();
    [[nodiscard]] size_t roomBytes() const { return window_.roomBytes(); }
    // Returns true if an unsent datagram may be sent: a full one, or a flushed one.
    [[nodiscard]] bool canSend() const { return next_ < limit(); }
    // Returns true if an eighth of the window is free, so that a woken writer does not soon wait again.
    [[nodiscard]] bool muchRoom() const {
        return window_.roomBytes() >= settings_.shape.payloadBytes * settings_.shape.windowDatagrams / 8;
    }
    // Returns true if all members have acknowledged all flushed data.
    [[nodiscard]] bool allArrived() const { return acknowledged_ == window_.filled(); }

    void input(const Feedback& f, int64_t nowNs);
    // Sends due datagrams and returns the time of the next call. Call it also after write, flush and input. Before that
    // time, and without changes, it does nothing.
    int64_t tick(int64_t nowNs, DatagramSink& out);

    [[nodiscard]] const SenderCounters& counters() const { return counters_; }
    // Returns true if the stream waits for this member's acknowledgement or window.
    [[nodiscard]] bool waitsFor(const MemberState& m) const {
        return m.cumulative != next_ || (m.edge <= next_ && next_ != window_.filled());
    }
    // Returns true if a datagram within the member's window was sent and is not acknowledged.
    [[nodiscard]] bool lacks(const MemberState& m) const { return m.cumulative < earlier(m.edge, next_); }
    [[nodiscard]] const RateControl& rate() const { return rate_; }
    [[nodiscard]] Sequence next() const { return next_; }

private:
    [[nodiscard]] Sequence limit() const;
    [[nodiscard]] int64_t pollDelayNs() const;
    [[nodiscard]] int64_t largestRoundTripNs() const;
    [[nodiscard]] int64_t worthSending(double wireBytes) const;
    [[nodiscard]] double batchBytes(double wireBytes) const;
    bool sendRepair(int64_t nowNs, DatagramSink& out);
    void sendData(int64_t nowNs, DatagramSink& out);
    void skipAll();
    void sendPoll(int64_t nowNs, uint8_t flags, DatagramSink& out);
    void sendRow(const RetransmitPlanner::Repair& r, const SendWindow::Group& group, int64_t nowNs, DatagramSink& out);
    void sendDatagram(Sequence s, uint8_t flags, int64_t nowNs, DatagramSink& out);
    int64_t sendWhatMay(int64_t nowNs, DatagramSink& out);
    int64_t pollWhenNeeded(int64_t nowNs, DatagramSink& out);
    void takeEntries(const Feedback& f);
    void takeEntry(const Missing& m, uint32_t echoUs);
    void measureRoundTrip(MemberState& m, const Feedback& f, int64_t nowNs) const;
    void advance();
    void updateEdge();
    void endRound(int64_t nowNs);
    void surviveJump(int64_t nowNs);
    void updateDemand(Sequence from, Sequence to);
    [[nodiscard]] int rowsAheadFor(int groupSize) const;

    SenderSettings settings_;
    SendWindow window_;
    RetransmitPlanner repairs_;
    RateControl rate_;
    std::map<MemberId, MemberState> members_;
    SenderCounters counters_;
    uint64_t writtenBytes_ = 0;

    Sequence next_;              // first datagram that was never sent
    Sequence acknowledged_;      // everything before is acknowledged by all
    Sequence flushed_;           // end of the last flush
    Sequence edge_;              // smallest window edge of all members; meaningless without members
    int repairCredit_ = 0;       // repairs that may precede the next datagram
    double needShare_ = 0;       // recently needed parity symbols per datagram
    int64_t sentNs_ = INT64_MIN; // time of the last datagram of any type
    int64_t pollAtNs_ = INT64_MAX;
    int pollsWithoutAnswer_ = 0;
    bool pollNow_ = false;
    int64_t tickedNs_ = INT64_MIN;
    int64_t dueNs_ = INT64_MIN; // time of the next due work
    bool changed_ = false;      // state has changed since dueNs_ was computed
    int64_t roundBeganNs_ = INT64_MIN;
    Sequence roundNext_;
    std::map<MemberId, uint32_t> roundLost_;
};

} // namespace mural::rsp
