#include "compositor/strategies/schedule.hpp"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <map>
#include <utility>

#include "compositor/strategies/schedule_maker.hpp"

namespace mural::compositor {

namespace {

// Simulates the schedule and records, for every piece, the number of waits before its sender can send it.
void countStages(Schedule& schedule) {
    std::vector<size_t> next(schedule.size(), 0);
    std::vector<int> waits(schedule.size(), 0);
    std::map<std::pair<size_t, size_t>, std::deque<int>> under; // by sender and receiver: stages of pieces in flight
    for (bool moved = true; moved;) {
        moved = false;
        for (size_t rank = 0; rank < schedule.size(); ++rank) {
            for (; next[rank] < schedule[rank].size(); ++next[rank], moved = true) {
                Step& step = schedule[rank][next[rank]];
                const auto peer = static_cast<size_t>(step.peer);
                if (!step.receives()) {
                    under[{rank, peer}].push_back(waits[rank]);
                    continue;
                }
                std::deque<int>& coming = under[{peer, rank}];
                if (coming.empty()) break;
                step.stage = coming.front();
                coming.pop_front();
                waits[rank] = std::max(waits[rank], step.stage + 1);
            }
        }
    }
}

} // namespace

RowRange ScheduleMaker::band(int index, int count) const {
    const auto edge = [&](int at) { return static_cast<int32_t>(int64_t{rows_} * at / count); };
    return {edge(index), edge(index + 1)};
}

void ScheduleMaker::round(std::span<const RowTransfer> transfers) {
    for (const RowTransfer& t : transfers)
        if (!t.rows.empty()) steps_[static_cast<size_t>(t.from)].push_back({Step::Kind::Send, t.to, t.rows, 0});
    std::vector<RowTransfer> taken(transfers.begin(), transfers.end());
    std::ranges::stable_sort(taken, {}, &RowTransfer::distance);
    for (const RowTransfer& t : taken)
        if (!t.rows.empty()) steps_[static_cast<size_t>(t.to)].push_back({t.kind, t.from, t.rows, 0});
}

Schedule ScheduleMaker::finish() {
    countStages(steps_);
    return std::move(steps_);
}

Schedule makeSchedule(Strategy strategy, int ranks, int32_t rows) {
    ScheduleMaker maker(ranks, rows);
    switch (strategy) {
    case Strategy::Serial: makeSerial(maker); break;
    case Strategy::DirectSend: makeDirectSend(maker); break;
    case Strategy::BinarySwap: makeBinarySwap(maker); break;
    case Strategy::TwoThreeSwap: makeTwoThreeSwap(maker); break;
    case Strategy::RadixK: makeRadixK(maker); break;
    case Strategy::Streaming: makeStreaming(maker); break;
    }
    return maker.finish();
}

namespace {

// The collector composites the nearest neighbours in the order first.
void makeSerialInOrder(ScheduleMaker& maker, std::span<const int> order) {
    const auto own = static_cast<int>(std::ranges::find(order, 0) - order.begin());
    std::vector<RowTransfer> all;
    for (int at = 0; at < maker.ranks(); ++at) {
        if (at == own) continue;
        const auto kind = at < own ? Step::Kind::FoldEarlier : Step::Kind::FoldLater;
        all.push_back({order[static_cast<size_t>(at)], 0, maker.band(0, 1), kind, std::abs(at - own)});
    }
    maker.round(all);
}

Step::Kind reversed(Step::Kind kind) {
    if (kind == Step::Kind::FoldEarlier) return Step::Kind::FoldLater;
    return kind == Step::Kind::FoldLater ? Step::Kind::FoldEarlier : kind;
}

} // namespace

// Makes the schedule of positions, and replaces positions by ranks. The collector's position is the first one: an order
// in which it is the last is reversed, together with the sides of all pieces.
Schedule makeSchedule(Strategy strategy, std::span<const int> order, int32_t rows) {
    const auto ranks = static_cast<int>(order.size());
    if (strategy == Strategy::Serial) {
        ScheduleMaker maker(ranks, rows);
        makeSerialInOrder(maker, order);
        return maker.finish();
    }
    std::vector<int> at(order.begin(), order.end());
    const bool isReversed = at.back() == 0 && ranks > 1;
    if (isReversed) std::ranges::reverse(at);
    const Schedule positions = makeSchedule(strategy, ranks, rows);
    Schedule schedule(order.size());
    for (size_t position = 0; position < at.size(); ++position)
        for (Step step : positions[position]) {
            step.peer = at[static_cast<size_t>(step.peer)];
            if (isReversed) step.kind = reversed(step.kind);
            schedule[static_cast<size_t>(at[position])].push_back(step);
        }
    if (at.front() != 0 && rows > 0) {
        schedule[static_cast<size_t>(at.front())].push_back({Step::Kind::Send, 0, {0, rows}, 0});
        schedule[0].push_back({Step::Kind::Place, at.front(), {0, rows}, 0});
        countStages(schedule);
    }
    return schedule;
}

} // namespace mural::compositor
