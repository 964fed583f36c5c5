// One line of what `mural bench accuracy` has measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/mural/accuracy/measured_error.hpp"

namespace mural::cli {

struct AccuracyRow {
    std::string group;     // heading under which it stands
    std::string what;      // that was measured
    std::string reference; // that it was compared with
    MeasuredError error;
    Bound bound;
    std::string failure; // why it could not be measured; empty: it was

    [[nodiscard]] bool holds() const { return failure.empty() && bound.holds(error); }
};

// All that is told of one run.
struct AccuracyReport {
    std::string subject; // what was drawn, at which size
    std::string gl;      // renderer and version; empty: unknown
    std::vector<AccuracyRow> rows;

    [[nodiscard]] bool holds() const;
};

using SayProgress = std::function<void(const std::string&)>;

} // namespace mural::cli
