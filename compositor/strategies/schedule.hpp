// Composition schedule: transfers of rows between ranks, and the order of compositing. A pure function of strategy,
// ranks and rows, so all nodes compute the same schedule without communication.
//
// Ranks are in draw order. Initially rank r holds its own drawing of all rows; finally rank 0, the collector, holds the
// complete picture. In between each rank holds, per row, the result of a run of neighbouring ranks. Only neighbouring
// runs are composited, because the draw order decides equal depths.
#pragma once

#include <cstdint>
#include <span>
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
        Send,        // sends these rows to the peer, which owns them afterwards
        FoldEarlier, // composites the peer's rows, drawn before those held here
        FoldLater,   // the same, drawn after
        Place,       // replaces the rows held here by the peer's, which contain them
    };
    Kind kind = Kind::Send;
    int peer = 0;
    RowRange rows;
    int stage = 0; // received steps: number of sequential waits of the peer before it sends

    [[nodiscard]] bool receives() const { return kind != Kind::Send; }
    friend bool operator==(const Step&, const Step&) = default;
};

// Steps per rank, in order. Sends do not wait; pieces between two ranks arrive in order.
using Schedule = std::vector<std::vector<Step>>;

// Requires ranks >= 1.
[[nodiscard]] Schedule makeSchedule(Strategy strategy, int ranks, int32_t rows);

// The same for another draw order: `order` holds the ranks, the first drawn first. Rank 0 remains the collector. If it
// is neither first nor last, it receives the complete picture in a step of its own, except with the serial strategy.
[[nodiscard]] Schedule makeSchedule(Strategy strategy, std::span<const int> order, int32_t rows);

} // namespace mural::compositor
