#include "transport/rsp/protocol/sender.hpp"

#include <algorithm>

#include "common/base/copy_bytes.hpp"
#include "transport/rsp/erasure/erasure_code.hpp"

namespace mural::rsp {

namespace {

constexpr int kMaxRepairCredit = 64;
constexpr int64_t kMaxPollNs = 50'000'000;
constexpr int64_t kMinPollNs = 300'000;
constexpr int64_t kUnknownRoundTripNs = 10'000'000;
constexpr int64_t kMinBatch = 8; // datagrams that justify a wake-up

uint32_t toUs(int64_t ns) { return static_cast<uint32_t>(ns / 1000); }

} // namespace

Sender::Sender(const SenderSettings& settings, Sequence first)
    : settings_(settings),
      window_(settings.shape, first),
      repairs_(settings.shape.windowDatagrams),
      rate_(settings.rate),
      next_(first),
      acknowledged_(first),
      flushed_(first),
      roundNext_(first) {}

Sequence Sender::addMember(MemberId id, int64_t nowNs) {
    window_.flush(); // the new member's stream begins with a group
    MemberState m;
    // Nothing counts for the member before its first feedback: the control connection announces the start of the
    // stream, and datagrams may overtake it. Earlier datagrams would count as losses and as congestion.
    m.cumulative = m.edge = window_.filled();
    m.receivedNs = m.movedNs = nowNs;
    members_[id] = m;
    changed_ = true;
    updateEdge();
    return m.cumulative;
}

size_t Sender::write(std::span<const std::byte> bytes) {
    const size_t written = window_.write(bytes);
    writtenBytes_ += written;
    changed_ = true;
    return written;
}

void Sender::removeMember(MemberId id) {
    members_.erase(id);
    roundLost_.erase(id);
    changed_ = true;
    updateEdge();
    advance();
}

void Sender::flush() {
    window_.flush();
    flushed_ = window_.filled();
    pollNow_ = next_ == window_.filled() && acknowledged_ != next_;
    changed_ = true;
}

void Sender::updateEdge() {
    edge_ = window_.base() + settings_.shape.windowDatagrams;
    for (const auto& [id, m] : members_) edge_ = earlier(edge_, m.edge);
}

Sequence Sender::limit() const { return earlier(edge_, window_.filled()); }

int64_t Sender::largestRoundTripNs() const {
    int64_t largest = 0;
    for (const auto& [id, m] : members_) largest = std::max(largest, m.roundTripNs);
    return largest;
}

int64_t Sender::pollDelayNs() const {
    int64_t delay = kMinPollNs;
    for (const auto& [id, m] : members_) {
        if (!waitsFor(m)) continue;
        const int64_t own = m.roundTripNs == 0 ? kUnknownRoundTripNs
                                               : std::max(m.roundTripNs * 3 / 2, m.roundTripNs + 4 * m.roundTripVarNs);
        delay = std::max(delay, own);
    }
    return std::min(kMaxPollNs, delay << std::min(pollsWithoutAnswer_, 8));
}

void Sender::sendDatagram(Sequence s, uint8_t flags, int64_t nowNs, DatagramSink& out) {
    const auto payload = window_.payload(s);
    const SendWindow::Group group = window_.groupOf(s);
    StreamDatagram d;
    d.type = Type::Data;
    d.flags = flags;
    d.from = settings_.self;
    d.sequence = s;
    d.index = static_cast<uint8_t>(s - group.base);
    d.groupSize = group.size;
    d.rowsSent = static_cast<uint8_t>(repairs_.rowsSent(group.base));
    d.sentUs = toUs(nowNs);
    d.next = later(next_, s + 1);
    const auto to = out.datagram(kEverybody, kStreamHeaderBytes + payload.size());
    writeStreamHeader(d, to);
    copyBytes(payload, to.subspan(kStreamHeaderBytes));
    sentNs_ = nowNs;
}

void Sender::sendData(int64_t nowNs, DatagramSink& out) {
    const SendWindow::Group group = window_.groupOf(next_);
    if (group.base == next_) repairs_.begin(next_);
    const bool groupEnd = group.size != 0 && next_ == group.base + group.size - 1;
    // Data that is not flushed is probably followed by more; otherwise a POLL follows after a delay.
    const bool last = next_ + 1 == flushed_ && next_ + 1 == window_.filled();
    sendDatagram(next_, last || next_ + 1 == edge_ ? flag::kPoll : uint8_t{0}, nowNs, out);
    counters_.bytes += window_.payload(next_).size();
    ++counters_.datagrams;
    ++next_;
    repairCredit_ = std::min(repairCredit_ + 1, kMaxRepairCredit);
    if (!groupEnd || group.size == kMaxInGroup || !settings_.parity) return;
    if (const int rows = rowsAheadFor(group.size)) {
        repairs_.wantAhead(group, rows);
        counters_.rowsAhead += static_cast<uint64_t>(rows);
    }
}

// No members.
void Sender::skipAll() {
    next_ = window_.filled();
    advance();
    roundNext_ = next_;
}

void Sender::sendRow(const RetransmitPlanner::Repair& r, const SendWindow::Group& group, int64_t nowNs,
                     DatagramSink& out) {
    size_t longest = 0;
    for (int i = 0; i < group.size; ++i) longest = std::max(longest, window_.payload(group.base + i).size());
    StreamDatagram d;
    d.type = Type::Parity;
    d.flags = flag::kRepair;
    d.from = settings_.self;
    d.sequence = group.base;
    d.groupSize = group.size;
    d.row = r.index;
    d.rowsSent = r.rowsSent;
    d.sentUs = toUs(nowNs);
    d.next = next_;
    const auto to = out.datagram(kEverybody, kStreamHeaderBytes + kLengthBytes + longest);
    writeStreamHeader(d, to);
    const auto symbol = to.subspan(kStreamHeaderBytes);
    std::ranges::fill(symbol, std::byte{0});
    for (int i = 0; i < group.size; ++i) addSymbol(symbol, r.index, i, window_.payload(group.base + i));
    sentNs_ = nowNs;
    ++counters_.rows;
}

bool Sender::sendRepair(int64_t nowNs, DatagramSink& out) {
    // A group in transmission gets no parity yet: it would cover datagrams that are not sent.
    std::optional<Sequence> partial;
    if (next_ < window_.filled()) {
        const Sequence base = window_.groupOf(next_).base;
        if (base != next_) partial = base;
    }
    const auto repair = repairs_.take(window_.base(), partial, next_ >= limit(), toUs(nowNs));
    if (!repair) return false;
    --repairCredit_;
    const SendWindow::Group group = window_.groupOf(repair->base);
    if (repair->resend) {
        sendDatagram(repair->base + repair->index, flag::kRepair, nowNs, out);
        ++counters_.resent;
    } else {
        sendRow(*repair, group, nowNs, out);
    }
    return true;
}

void Sender::sendPoll(int64_t nowNs, uint8_t flags, DatagramSink& out) {
    const SendWindow::Group group = window_.newestGroup();
    const bool sent = group.filled != 0 && group.base < next_;
    StreamDatagram d;
    d.type = Type::Poll;
    d.flags = flags;
    d.from = settings_.self;
    d.sequence = sent ? group.base : next_;
    d.groupSize = sent ? group.size : 0;
    d.sentUs = toUs(nowNs);
    d.next = next_;
    writeStreamHeader(d, out.datagram(kEverybody, kStreamHeaderBytes));
    sentNs_ = nowNs;
    ++counters_.polls;
}

// Polls at the end of the sendable data until all members have answered: the last datagrams, or the feedback that
// reopens a window, may be lost.
int64_t Sender::pollWhenNeeded(int64_t nowNs, DatagramSink& out) {
    const bool waiting = acknowledged_ != next_ || next_ != window_.filled();
    if (pollNow_ && waiting) sendPoll(nowNs, flag::kPoll, out);
    pollNow_ = false;
    if (!waiting) {
        pollAtNs_ = INT64_MAX;
    } else if (pollAtNs_ == INT64_MAX) {
        pollsWithoutAnswer_ = 0;
        pollAtNs_ = nowNs + pollDelayNs();
    } else if (nowNs >= pollAtNs_) {
        sendPoll(nowNs, flag::kPoll, out);
        ++pollsWithoutAnswer_;
        pollAtNs_ = nowNs + pollDelayNs();
    }
    if (nowNs - sentNs_ >= settings_.heartbeatNs) sendPoll(nowNs, 0, out);
    return std::min(pollAtNs_, sentNs_ + settings_.heartbeatNs);
}

// Returns the number of datagrams that justifies a wake-up, here and at all receivers.
int64_t Sender::worthSending(double wireBytes) const {
    const auto maximum = static_cast<int64_t>(maxInSend(static_cast<size_t>(wireBytes) - kWireOverheadBytes));
    return std::clamp(static_cast<int64_t>(rate_.batchBytes() / wireBytes), std::min(kMinBatch, maximum), maximum);
}

// The end of a flush does not wait for tokens beyond its own datagrams.
double Sender::batchBytes(double wireBytes) const {
    const int64_t waiting = std::max<int64_t>(1, limit() - next_);
    const int64_t datagrams = worthSending(wireBytes);
    return static_cast<double>(repairs_.empty() ? std::min(datagrams, waiting) : datagrams) * wireBytes;
}

int64_t Sender::tick(int64_t nowNs, DatagramSink& out) {
    surviveJump(nowNs);
    if (!changed_ && nowNs < dueNs_) return dueNs_;
    changed_ = false;
    return dueNs_ = sendWhatMay(nowNs, out);
}

int64_t Sender::sendWhatMay(int64_t nowNs, DatagramSink& out) {
    if (sentNs_ == INT64_MIN) sentNs_ = nowNs;
    if (members_.empty()) {
        skipAll();
        return nowNs + settings_.heartbeatNs;
    }
    for (auto& [id, m] : members_) {
        if (!waitsFor(m)) m.movedNs = nowNs;
    }
    endRound(nowNs);
    const auto bytes = static_cast<double>(kWireOverheadBytes + kStreamHeaderBytes + kLengthBytes +
                                           settings_.shape.payloadBytes + settings_.tagBytes);
    // While more than a batch waits, send whole batches only: the kernel's cost per system call is independent of their
    // size.
    const int64_t worth = worthSending(bytes);
    for (int64_t sent = 0;; ++sent) {
        if (sent % worth == 0 && limit() - next_ >= worth) {
            const double whole = static_cast<double>(worth) * bytes;
            if (!rate_.has(whole, nowNs)) return std::min(rate_.whenNs(whole, nowNs), nowNs + settings_.heartbeatNs);
        }
        if (!rate_.take(bytes, nowNs))
            return std::min(rate_.whenNs(batchBytes(bytes), nowNs), nowNs + settings_.heartbeatNs);
        const bool more = next_ < limit();
        if ((repairCredit_ > 0 || !more) && sendRepair(nowNs, out)) continue;
        if (!more) break;
        pollAtNs_ = INT64_MAX;
        sendData(nowNs, out);
    }
    rate_.giveBack(bytes);
    return pollWhenNeeded(nowNs, out);
}

} // namespace mural::rsp
