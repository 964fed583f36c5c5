#include "transport/rsp/protocol/retransmit_planner.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace mural::rsp {

namespace {
bool isAfter(uint32_t aUs, uint32_t bUs) { return static_cast<int32_t>(aUs - bUs) > 0; }
constexpr auto kOldestFirst = [](Sequence a, Sequence b) { return a > b; }; // heap order
} // namespace

RetransmitPlanner::RetransmitPlanner(uint32_t windowDatagrams) : mask_(windowDatagrams - 1), states_(windowDatagrams) {}

void RetransmitPlanner::begin(Sequence base) {
    State& s = states_[base.value() & mask_];
    s = State{};
    s.base = base;
}

const RetransmitPlanner::State* RetransmitPlanner::find(Sequence base) const {
    const State& s = states_[base.value() & mask_];
    return s.base == base ? &s : nullptr;
}

int RetransmitPlanner::rowsSent(Sequence base) const {
    const State* s = find(base);
    return s ? s->rowsSent : 0;
}

int RetransmitPlanner::rowsNeeded(Sequence base) const {
    const State* s = find(base);
    return s ? s->rowsWanted - s->rowsAhead : 0;
}

int RetransmitPlanner::rowsAhead(Sequence base) const {
    const State* s = find(base);
    return s ? s->rowsAhead : 0;
}

int RetransmitPlanner::rowsSentBy(const State& s, uint32_t us) {
    int count = s.rowsSent;
    const int oldest = std::max(0, count - kTimes);
    while (count > oldest && isAfter(s.sentUs[static_cast<size_t>(count - 1) % kTimes], us)) --count;
    return count;
}

void RetransmitPlanner::enqueue(State& s) {
    if (s.queued) return;
    s.queued = true;
    queue_.push_back(s.base);
    std::ranges::push_heap(queue_, kOldestFirst);
}

void RetransmitPlanner::want(const SendWindow::Group& group, uint32_t missing, int symbolsHeld, uint32_t echoUs) {
    const int lacking = std::popcount(missing) - symbolsHeld;
    if (lacking <= 0) return;
    State& s = states_[group.base.value() & mask_];
    const int wanted = rowsSentBy(s, echoUs) + lacking;
    if (wanted > kMaxRows) return wantAgain(group, missing, echoUs);
    s.missing |= missing;
    if (wanted <= s.rowsWanted) return;
    s.rowsWanted = static_cast<uint8_t>(wanted);
    enqueue(s);
}

void RetransmitPlanner::wantAgain(const SendWindow::Group& group, uint32_t missing, uint32_t echoUs) {
    State& s = states_[group.base.value() & mask_];
    if (s.hasResent && isAfter(s.resentUs, echoUs)) return; // may still be in flight
    s.resend |= missing;
    enqueue(s);
}

void RetransmitPlanner::wantAhead(const SendWindow::Group& group, int rows) {
    State& s = states_[group.base.value() & mask_];
    s.rowsAhead = static_cast<uint8_t>(rows);
    s.rowsWanted = std::max(s.rowsWanted, s.rowsAhead);
    enqueue(s);
}

std::optional<RetransmitPlanner::Repair> RetransmitPlanner::takeFrom(State& s, uint32_t sentUs) {
    if (s.rowsSent < s.rowsWanted) {
        s.sentUs[s.rowsSent % kTimes] = sentUs;
        ++s.rowsSent;
        return Repair{s.base, false, static_cast<uint8_t>(s.rowsSent - 1), s.rowsSent};
    }
    if (s.resend == 0) return {};
    const auto index = static_cast<uint8_t>(std::countr_zero(s.resend));
    s.resend &= s.resend - 1;
    s.resentUs = sentUs;
    s.hasResent = true;
    return Repair{s.base, true, index, s.rowsSent};
}

std::optional<RetransmitPlanner::Repair> RetransmitPlanner::take(Sequence oldest, std::optional<Sequence> partial,
                                                                 bool blocked, uint32_t sentUs) {
    while (!queue_.empty()) {
        const Sequence base = queue_.front();
        State& s = states_[base.value() & mask_];
        const bool live = s.base == base && base >= oldest;
        if (live && partial == base) {
            if (!blocked) return {}; // newest group: nothing waits behind it
            s.rowsWanted = s.rowsSent;
            s.resend |= std::exchange(s.missing, 0);
        }
        if (live) {
            if (const auto repair = takeFrom(s, sentUs)) return repair;
        }
        if (s.base == base) s.queued = false;
        std::ranges::pop_heap(queue_, kOldestFirst);
        queue_.pop_back();
    }
    return {};
}

} // namespace mural::rsp
