// The writing end of one stream to a group: what goes out when, and what is done about losses. No sockets, no clock, no
// threads: times come in, datagrams go to an Outbox, and tick() says when it wants to be called again.
//
// Source: thesis, section "Reliable Stream Protocol"; the differences are told in docs/transport.md.
#pragma once

#include <map>
#include <vector>

#include "transport/rsp/outbox.hpp"
#include "transport/rsp/rate_control.hpp"
#include "transport/rsp/repair_plan.hpp"
#include "transport/rsp/send_window.hpp"

namespace mural::rsp {

struct SenderSettings {
    StreamShape shape;
    MemberId self = 0;
    RateSettings rate;
    size_t tagBytes = 0;    // what the seal adds to each datagram, for the rate
    bool parity = true;     // false: losses are mended by sending the datagrams again, to measure against
    int64_t heartbeatNs = 100'000'000;
};

// What the writer knows of a member.
struct MemberState {
    Sequence cumulative;
    Sequence edge;
    int64_t heardNs = 0;     // last time that it is known to have heard us
    int64_t movedNs = 0;     // last time that cumulative or edge moved, or nothing was owed
    int64_t roundTripNs = 0; // smoothed; 0: not known
    int64_t roundTripVarNs = 0;
    uint32_t lost = 0;    // as told
    uint32_t dropped = 0; // by its own socket, as told
    double lostShare = 0; // of the last round
};

struct SenderCounters {
    uint64_t bytes = 0; // of payload, first sendings
    uint64_t datagrams = 0;
    uint64_t rows = 0;
    uint64_t rowsAhead = 0; // among rows
    uint64_t resent = 0;
    uint64_t polls = 0;
    uint64_t feedback = 0;
    uint64_t refused = 0; // feedback that can't be true
};

class Sender {
public:
    Sender(const SenderSettings& settings, Sequence first);

    // The new member gets the stream from the returned number on.
    Sequence addMember(MemberId id, int64_t nowNs);
    // Nobody waits for this one any longer.
    void removeMember(MemberId id);
    [[nodiscard]] const std::map<MemberId, MemberState>& members() const { return members_; }

    // Members say at once what they lack.
    void ask() { pollNow_ = changed_ = true; }

    // Copies what there is room for; returns how much. Without members all is taken, and nobody gets it.
    size_t write(std::span<const std::byte> bytes);
    // So many bytes since the start: where a member that is added now begins.
    [[nodiscard]] uint64_t writtenBytes() const { return writtenBytes_; }
    // What was written goes out now, and members say at once that they have it.
    void flush();
    [[nodiscard]] size_t roomBytes() const { return window_.roomBytes(); }
    // Something that was not sent yet may be: a whole datagram, or what was flushed.
    [[nodiscard]] bool canSend() const { return next_ < limit(); }
    // Enough that a writer who waits for room need not soon wait again.
    [[nodiscard]] bool muchRoom() const { return window_.roomBytes() >= settings_.shape.payloadBytes * settings_.shape.windowDatagrams / 8; }
    // All that was flushed has arrived everywhere.
    [[nodiscard]] bool allArrived() const { return acknowledged_ == window_.filled(); }

    void input(const Feedback& f, int64_t nowNs);
    // Sends what may be sent now; returns when to come again at the latest. Call it after write, flush and input, too. Before
    // that time, and when nothing has changed, it does nothing.
    int64_t tick(int64_t nowNs, Outbox& out);

    [[nodiscard]] const SenderCounters& counters() const { return counters_; }
    // Whether the stream waits for this member: for its word that it has all, or for room.
    [[nodiscard]] bool waitsFor(const MemberState& m) const {
        return m.cumulative != next_ || (m.edge <= next_ && next_ != window_.filled());
    }
    // Whether something that it has room for was sent and did not arrive, or not yet.
    [[nodiscard]] bool lacks(const MemberState& m) const { return m.cumulative < earlier(m.edge, next_); }
    [[nodiscard]] const RateControl& rate() const { return rate_; }
    [[nodiscard]] Sequence next() const { return next_; }

private:
    [[nodiscard]] Sequence limit() const;
    [[nodiscard]] int64_t pollDelayNs() const;
    [[nodiscard]] int64_t largestRoundTripNs() const;
    [[nodiscard]] int64_t worthSending(double wireBytes) const;
    [[nodiscard]] double batchBytes(double wireBytes) const;
    bool sendRepair(int64_t nowNs, Outbox& out);
    void sendData(int64_t nowNs, Outbox& out);
    void skipAll();
    void sendPoll(int64_t nowNs, uint8_t flags, Outbox& out);
    void sendRow(const RepairPlan::Repair& r, const SendWindow::Group& group, int64_t nowNs, Outbox& out);
    void sendDatagram(Sequence s, uint8_t flags, int64_t nowNs, Outbox& out);
    int64_t sendWhatMay(int64_t nowNs, Outbox& out);
    int64_t pollWhenNeeded(int64_t nowNs, Outbox& out);
    void takeEntries(const Feedback& f);
    void takeEntry(const Missing& m, uint32_t echoUs);
    void measureRoundTrip(MemberState& m, const Feedback& f, int64_t nowNs) const;
    void advance();
    void updateEdge();
    void endRound(int64_t nowNs);
    void surviveJump(int64_t nowNs);
    void learnNeed(Sequence from, Sequence to);
    [[nodiscard]] int rowsAheadFor(int groupSize) const;

    SenderSettings settings_;
    SendWindow window_;
    RepairPlan repairs_;
    RateControl rate_;
    std::map<MemberId, MemberState> members_;
    SenderCounters counters_;
    uint64_t writtenBytes_ = 0;

    Sequence next_;         // the first that was never sent
    Sequence acknowledged_; // all before it are everywhere
    Sequence flushed_;      // behind the last flush
    Sequence edge_;         // the least of the members' edges; without members without meaning
    int repairCredit_ = 0;  // repairs that may go before the next datagram
    double needShare_ = 0;  // rows per datagram that groups need lately
    int64_t sentNs_ = INT64_MIN; // last datagram of any kind
    int64_t pollAtNs_ = INT64_MAX;
    int pollsWithoutAnswer_ = 0;
    bool pollNow_ = false;
    int64_t tickedNs_ = INT64_MIN;
    int64_t dueNs_ = INT64_MIN; // when something is to be done at the latest
    bool changed_ = false;      // since that was found
    int64_t roundBeganNs_ = INT64_MIN;
    Sequence roundNext_;
    std::map<MemberId, uint32_t> roundLost_;
};

} // namespace mural::rsp
