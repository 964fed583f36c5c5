// Writes the steps of all ranks from transfers between them. A strategy is a function that gives it transfers.
#pragma once

#include <span>

#include "compositor/strategies/schedule.hpp"

namespace mural::compositor {

struct RowTransfer {
    int from = 0;
    int to = 0;
    RowRange rows;
    Step::Kind kind = Step::Kind::Place; // for the receiver
    int distance = 0;                    // the receiver takes the nearest first
};

class ScheduleMaker {
public:
    ScheduleMaker(int ranks, int32_t rows) : steps_(static_cast<size_t>(ranks)), rows_(rows) {}

    [[nodiscard]] int ranks() const { return static_cast<int>(steps_.size()); }
    [[nodiscard]] int32_t rows() const { return rows_; }
    // Band `index` of `count` that divide the picture evenly.
    [[nodiscard]] RowRange band(int index, int count) const;
    // All that is sent is what was held before the round; then what came is taken. Transfers of no rows are left out.
    void round(std::span<const RowTransfer> transfers);
    void transfer(const RowTransfer& one) { round({&one, 1}); }
    [[nodiscard]] Schedule finish();

private:
    Schedule steps_;
    int32_t rows_;
};

// The strategies.
void makeSerial(ScheduleMaker& maker);
void makeDirectSend(ScheduleMaker& maker);
void makeBinarySwap(ScheduleMaker& maker);
void makeTwoThreeSwap(ScheduleMaker& maker);
void makeRadixK(ScheduleMaker& maker);
void makeStreaming(ScheduleMaker& maker);

} // namespace mural::compositor
