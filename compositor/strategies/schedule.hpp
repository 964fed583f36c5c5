// Who sends which rows of the picture to whom, and what is folded in which order: a pure function of strategy, number of ranks
// and rows, so that all nodes make the same one without a word.
//
// Ranks stand in draw order. Before, rank r holds what r drew, of all rows; afterwards rank 0, the collector, holds what all have
// drawn. In between each holds, row by row, what a run of neighbouring ranks has drawn: only neighbouring runs are folded, for
// where depths tie the draw order decides.
#pragma once

#include <cstdint>
#include <vector>

#include "compositor/strategies/strategy.hpp"

namespace mural::compositor {

struct RowRange {
    int32_t first = 0;
    int32_t end = 0;

    [[nodiscard]] constexpr bool empty() const { return end <= first; }
    [[nodiscard]] constexpr int32_t count() const { return empty() ? 0 : end - first; }
    friend constexpr bool operator==(const RowRange&, const RowRange&) = default;
};

struct Step {
    enum class Kind : uint8_t {
        Send,        // these rows, as they are, to the peer; they are its from then on
        FoldEarlier, // the peer's rows were drawn before what is held here
        FoldLater,   // …after
        Place,       // the peer's rows take the place of what is here, which is in them
    };
    Kind kind = Kind::Send;
    int peer = 0;
    RowRange rows;
    int stage = 0; // of what is received: how many waits, one after the other, the peer may have had before it sent this

    [[nodiscard]] bool receives() const { return kind != Kind::Send; }
    friend bool operator==(const Step&, const Step&) = default;
};

// By rank: its steps, one after the other. Sends wait for nobody; pieces from one rank to another arrive in their order.
using Schedule = std::vector<std::vector<Step>>;

// ranks: from 1 on.
[[nodiscard]] Schedule makeSchedule(Strategy strategy, int ranks, int32_t rows);

} // namespace mural::compositor
