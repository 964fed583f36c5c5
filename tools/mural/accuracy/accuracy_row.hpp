// One row of the results of `mural bench accuracy`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/mural/accuracy/measured_error.hpp"

namespace mural::cli {

// Cost per pixel of the result.
struct Cost {
    double cpuNs = 0; // of all threads involved
    double bytes = 0; // transferred or read
};

struct AccuracyRow {
    std::string group;     // heading
    std::string what;      // measured method
    std::string reference; // reference
    MeasuredError error;
    Bound bound;
    std::string failure;           // reason of a failed measurement; empty: none
    std::optional<Cost> cost = {}; // if measured

    [[nodiscard]] bool holds() const { return failure.empty() && bound.holds(error); }
};

struct AccuracyCounts {
    size_t measured = 0;
    size_t broken = 0; // rows outside of their bound
    size_t failed = 0; // rows without a measurement
};

// Results of one run.
struct AccuracyReport {
    std::string subject; // drawn contents and size
    std::string gl;      // renderer and version; empty: unknown
    std::vector<AccuracyRow> rows;

    [[nodiscard]] bool holds() const;
    [[nodiscard]] AccuracyCounts counts() const;
    // Returns 0: all bounds hold; 1: a bound is violated, or a measurement failed; 2: no measurement was possible.
    [[nodiscard]] int exitStatus() const;
};

} // namespace mural::cli
