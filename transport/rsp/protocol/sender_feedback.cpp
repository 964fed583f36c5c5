// Processing of members' feedback.
#include "transport/rsp/protocol/sender.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace mural::rsp {

namespace {
constexpr int64_t kJumpNs = 250'000'000; // a longer gap between two ticks means that this process did not run
constexpr int kMaxRowsAhead = 4;
constexpr double kNeedSmoothing = 1.0 / 64; // per group
constexpr int64_t kMinRoundDatagrams = 256; // fewer datagrams say little about losses
constexpr int64_t kSaneRoundTripNs = 10'000'000'000;
} // namespace

void Sender::measureRoundTrip(MemberState& m, const Feedback& f, int64_t nowNs) const {
    const uint32_t elapsedUs = static_cast<uint32_t>(nowNs / 1000) - f.echoUs - f.ackDelayUs;
    const int64_t sampleNs = int64_t{elapsedUs} * 1000;
    if (f.echoUs == 0 || sampleNs > kSaneRoundTripNs) return;
    if (m.roundTripNs == 0) {
        m.roundTripNs = std::max<int64_t>(1, sampleNs);
        m.roundTripVarNs = sampleNs / 2;
        return;
    }
    m.roundTripVarNs += (std::abs(sampleNs - m.roundTripNs) - m.roundTripVarNs) / 4;
    m.roundTripNs = std::max<int64_t>(1, m.roundTripNs + (sampleNs - m.roundTripNs) / 8);
}

void Sender::input(const Feedback& f, int64_t nowNs) {
    const auto found = members_.find(f.from);
    if (found == members_.end() || f.to != settings_.self) return;
    MemberState& m = found->second;
    changed_ = true;
    ++counters_.feedback;
    if (f.cumulative > next_ || f.highest > next_ || f.cumulative > f.highest) {
        ++counters_.refused;
        return;
    }
    // A member that sends but does not receive counts as silent.
    m.receivedNs = std::max(m.receivedNs, nowNs - int64_t{f.ackDelayUs} * 1000);
    m.lost = f.lost;
    m.dropped = f.dropped;
    measureRoundTrip(m, f, nowNs);
    // Feedback may be reordered: values never decrease.
    const bool moved = f.cumulative > m.cumulative || f.edge > m.edge;
    m.cumulative = later(m.cumulative, f.cumulative);
    m.edge = later(m.edge, earlier(f.edge, m.cumulative + settings_.shape.windowDatagrams));
    if (moved) {
        m.movedNs = nowNs;
        pollsWithoutAnswer_ = 0;
    }
    takeEntries(f);
    advance();
    updateEdge();
}

void Sender::takeEntries(const Feedback& f) {
    for (size_t i = 0; i < f.entryCount; ++i) {
        const Missing& m = f.entries[i];
        if (m.base < next_)
            takeEntry(m, f.echoUs);
        else
            ++counters_.refused;
    }
}

// An entry may span groups: a member that has received nothing of a group does not know its start.
void Sender::takeEntry(const Missing& m, uint32_t echoUs) {
    uint32_t left = m.missing;
    while (left != 0) {
        const Sequence s = m.base + std::countr_zero(left);
        if (s < window_.base() || s >= next_) {
            left &= left - 1;
            continue;
        }
        SendWindow::Group group = window_.groupOf(s);
        const auto offset = m.base - group.base; // offset of the entry within the group, or negative
        if (group.size == 0 && group.base + group.filled == window_.filled()) {
            window_.closeGroup();
            group = window_.groupOf(s);
        }
        const uint32_t whole = group.size == kMaxInGroup ? ~0u : (1u << group.size) - 1;
        const uint32_t missing = (offset >= 0 ? m.missing << offset : m.missing >> -offset) & whole;
        const uint32_t covered = offset >= 0 ? whole >> offset : whole << -offset;
        // Only an entry that begins at the group reports its parity symbols.
        const int rows = m.base == group.base ? m.rows : 0;
        if (settings_.parity)
            repairs_.want(group, missing, rows, echoUs);
        else
            repairs_.wantAgain(group, missing, echoUs);
        left &= ~covered;
    }
}

void Sender::advance() {
    Sequence all = next_;
    for (const auto& [id, m] : members_) all = earlier(all, m.cumulative);
    if (all <= acknowledged_) return;
    updateDemand(acknowledged_, all);
    acknowledged_ = all;
    window_.release(all);
}

// Learns how many parity symbols per datagram completed groups needed. The next short group receives as many in
// advance.
void Sender::updateDemand(Sequence from, Sequence to) {
    for (Sequence s = from; s < to;) {
        const SendWindow::Group group = window_.groupOf(s);
        const Sequence end = group.base + group.filled;
        if (end > to || group.size == 0) return;
        const int requested = repairs_.rowsNeeded(group.base);
        const int ahead = repairs_.rowsAhead(group.base);
        // Feedback does not reveal whether advance parity was needed: each group without requests lowers the estimate
        // by one.
        const int rows = requested > 0 ? ahead + requested : std::max(0, ahead - 1);
        const double share = static_cast<double>(rows) / group.size;
        const double weight = kNeedSmoothing * group.size / kMaxInGroup;
        needShare_ += (share - needShare_) * std::max(weight, kNeedSmoothing / 4);
        s = end;
    }
}

int Sender::rowsAheadFor(int groupSize) const {
    return std::min(kMaxRowsAhead, static_cast<int>(std::lround(needShare_ * groupSize)));
}

void Sender::endRound(int64_t nowNs) {
    if (roundBeganNs_ == INT64_MIN) roundBeganNs_ = nowNs;
    if (nowNs - roundBeganNs_ < RateControl::roundNs(largestRoundTripNs())) return;
    const auto sent = next_ - roundNext_;
    if (sent < kMinRoundDatagrams) return;
    double worst = 0;
    for (auto& [id, m] : members_) {
        const uint32_t before = std::exchange(roundLost_[id], m.lost);
        const uint32_t lost = m.lost - before;
        m.lostShare = std::min(1.0, static_cast<double>(lost) / static_cast<double>(sent));
        worst = std::max(worst, m.lostShare);
    }
    roundBeganNs_ = nowNs;
    roundNext_ = next_;
    rate_.roundEnded(worst, sent, nowNs);
}

// A gap in this process's own execution is not silence of the members.
void Sender::surviveJump(int64_t nowNs) {
    const int64_t goneNs = tickedNs_ == INT64_MIN ? 0 : nowNs - tickedNs_;
    tickedNs_ = nowNs;
    if (goneNs < kJumpNs) return;
    for (auto& [id, m] : members_) {
        m.receivedNs += goneNs;
        m.movedNs += goneNs;
    }
}

} // namespace mural::rsp
