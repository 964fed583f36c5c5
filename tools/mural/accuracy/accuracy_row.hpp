// One line of what `mural bench accuracy` has measured.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/mural/accuracy/measured_error.hpp"

namespace mural::cli {

// What a pixel of the result takes.
struct Cost {
    double cpuNs = 0;  // of all threads that work at it
    double bytes = 0;  // that travel or are read for it
};

struct AccuracyRow {
    std::string group;     // heading under which it stands
    std::string what;      // that was measured
    std::string reference; // that it was compared with
    MeasuredError error;
    Bound bound;
    std::string failure; // why it could not be measured; empty: it was
    std::optional<Cost> cost = {}; // where it was measured, too

    [[nodiscard]] bool holds() const { return failure.empty() && bound.holds(error); }
};

struct AccuracyCounts {
    size_t measured = 0;
    size_t broken = 0; // of those
    size_t failed = 0; // not measured
};

// All that is told of one run.
struct AccuracyReport {
    std::string subject; // what was drawn, at which size
    std::string gl;      // renderer and version; empty: unknown
    std::vector<AccuracyRow> rows;

    [[nodiscard]] bool holds() const;
    [[nodiscard]] AccuracyCounts counts() const;
    // 0: all holds, 1: something is broken or failed, 2: nothing could be measured.
    [[nodiscard]] int exitStatus() const;
};

using SayProgress = std::function<void(const std::string&)>;

} // namespace mural::cli
