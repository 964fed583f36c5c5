#include "compositor/strategies/schedule.hpp"

#include <algorithm>
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

} // namespace mural::compositor
