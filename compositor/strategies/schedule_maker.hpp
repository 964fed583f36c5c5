// Builds the steps of all ranks from transfers between them. A strategy is a function that provides the transfers.
#pragma once

#include <span>

#include "compositor/strategies/schedule.hpp"

namespace mural::compositor {

struct RowTransfer {
    int from = 0;
    int to = 0;
    RowRange rows;
    Step::Kind kind = Step::Kind::Place; // at the receiver
    int distance = 0;                    // the receiver processes near ranks first
};

class ScheduleMaker {
public:
    ScheduleMaker(int ranks, int32_t rows) : steps_(static_cast<size_t>(ranks)), rows_(rows) {}

    [[nodiscard]] int ranks() const { return static_cast<int>(steps_.size()); }
    [[nodiscard]] int32_t rows() const { return rows_; }
    // Returns band `index` of `count` equal bands of the picture.
    [[nodiscard]] RowRange band(int index, int count) const;
    // Adds a round: all sends use the state before the round; then receives are processed. Empty transfers are omitted.
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
