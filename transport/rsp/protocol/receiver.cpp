#include "transport/rsp/protocol/receiver.hpp"

#include <algorithm>

namespace mural::rsp {

namespace {
constexpr int64_t kFirstRepairNs = 5'000'000;
constexpr int64_t kMinRepairNs = 2'000'000;
constexpr int64_t kMaxRepairNs = 100'000'000;
constexpr int64_t kMinSpacingNs = 500'000; // interval of unsolicited feedback: at most 2 000 per second
} // namespace

Receiver::Receiver(const ReceiverSettings& settings, Sequence first)
    : settings_(settings),
      window_(settings.shape, first),
      gaps_(first),
      ackEvery_(std::max(1u, std::min(settings.shape.windowDatagrams, settings.socketDatagrams) / 2)),
      sinceAck_(settings.self * 37u % ackEvery_),
      reportedEdge_(first),
      countedLost_(first),
      repairNs_(kFirstRepairNs) {}

// The window protects the ring and, while this process sleeps, the socket. An advertised edge is never reduced.
Sequence Receiver::edgeNow() const {
    const Sequence ring = window_.oldest() + settings_.shape.windowDatagrams;
    const Sequence socket = later(gaps_.highest(), window_.cumulative()) + settings_.socketDatagrams;
    return later(reportedEdge_, earlier(ring, socket));
}

void Receiver::input(const StreamDatagram& d, int64_t nowNs) {
    const Sequence before = window_.cumulative();
    const auto lateUs = static_cast<int32_t>(newestUs_ - d.sentUs);
    if (newestUs_ == 0 || lateUs <= 0) {
        newestUs_ = d.sentUs;
        newestNs_ = nowNs;
    }
    const bool repair = (d.flags & flag::kRepair) != 0;
    if (d.type == Type::Poll) {
        window_.updateGroupSize(d.sequence, d.groupSize);
        polled(d.next);
    } else if (d.type == Type::Parity) {
        if (window_.takeParity(d) == ReceiveWindow::InsertResult::New) ++sinceAck_;
    } else {
        const auto took = window_.takeData(d);
        if (took == ReceiveWindow::InsertResult::Refused) return;
        if (took == ReceiveWindow::InsertResult::New) ++sinceAck_;
        if (!repair && d.sequence < gaps_.lostBefore() && lateUs > 0) gaps_.onLateArrival(int64_t{lateUs} * 1000);
        // Datagrams before it are duplicates. Half of the number space further, the comparison wraps.
        if (d.sequence >= before) gaps_.arrived(d.sequence, nowNs);
        if (d.flags & flag::kPoll) polled(d.next);
    }
    if (d.flags & flag::kPoll) reportNow_ = true;
    if (repair && window_.cumulative() > before && requestedNs_ != INT64_MIN) {
        const int64_t tookNs = nowNs - requestedNs_;
        repairNs_ = std::clamp(repairNs_ + (2 * tookNs - repairNs_) / 4, kMinRepairNs, kMaxRepairNs);
    }
}

// Clamps to the receive window: a bogus POLL must not report datagrams as lost that were never sent.
void Receiver::polled(Sequence next) {
    const Sequence edge = window_.oldest() + settings_.shape.windowDatagrams;
    gaps_.polled(later(earlier(next, edge), gaps_.lostBefore()));
}

void Receiver::countLost(Sequence before) {
    for (; countedLost_ < before; ++countedLost_) {
        if (!window_.has(countedLost_)) ++lost_;
    }
}

// Returns true if the writer has used most of its window and waits, or soon will.
bool Receiver::spaceIsUnreported() const {
    const int64_t opened = edgeNow() - reportedEdge_;
    const int64_t left = reportedEdge_ - gaps_.highest();
    const auto whole = static_cast<int64_t>(std::min(settings_.shape.windowDatagrams, settings_.socketDatagrams));
    return opened >= std::max<int64_t>(1, whole / 8) && left < whole / 2;
}

int64_t Receiver::dueNs() const {
    if (reportNow_) return INT64_MIN;
    int64_t due = publishedNs_ + settings_.heartbeatNs;
    if (newlyLost_ || sinceAck_ >= ackEvery_ || spaceIsUnreported()) due = std::min(due, publishedNs_ + kMinSpacingNs);
    if (anyLost()) due = std::min(due, publishedNs_ + repairNs_);
    return due;
}

int64_t Receiver::tick(int64_t nowNs, DatagramSink& out) {
    if (newestNs_ == 0) newestNs_ = nowNs; // nothing received since then
    if (gaps_.expire(nowNs)) newlyLost_ = true;
    countLost(gaps_.lostBefore());
    if (nowNs >= dueNs()) sendFeedback(nowNs, out);
    return std::min(dueNs(), gaps_.whenNs());
}

void Receiver::sendFeedback(int64_t nowNs, DatagramSink& out) {
    Feedback f;
    f.from = settings_.self;
    f.to = settings_.writer;
    f.cumulative = window_.cumulative();
    f.edge = edgeNow();
    f.highest = later(gaps_.highest(), f.cumulative);
    f.echoUs = newestUs_;
    f.ackDelayUs = static_cast<uint32_t>((nowNs - newestNs_) / 1000);
    f.lost = lost_;
    f.dropped = dropped_;
    Sequence from = f.cumulative;
    while (f.entryCount < kMaxEntries) {
        const Missing m = window_.missingFrom(from, gaps_.lostBefore());
        if (m.span == 0) break;
        f.entries[f.entryCount++] = m;
        from = m.base + m.span;
    }
    if (f.entryCount > 0) requestedNs_ = nowNs;
    writeFeedback(f, out.datagram(settings_.writer, feedbackBytes(f)));
    publishedNs_ = nowNs;
    reportedEdge_ = f.edge;
    sinceAck_ = 0;
    reportNow_ = newlyLost_ = false;
    ++feedbackSent_;
}

} // namespace mural::rsp
