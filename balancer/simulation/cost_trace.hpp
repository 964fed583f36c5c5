// A cost trace: what each cell of the picture and each part of the range costs in each frame. Format:
// docs/reference/cost-trace.md.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::simulation {

struct CostFrame {
    std::vector<float> cells;  // seconds per cell, row-major, lowest row first
    std::vector<float> ranges; // seconds per part of the range, in ascending order
};

struct CostTrace {
    std::string name;
    size_t columns = 1, rows = 1; // of the picture
    size_t ranges = 1;
    std::vector<CostFrame> frames;
};

// Errors name the line.
Result<CostTrace> readCostTrace(std::istream& in, const std::string& name);
Result<CostTrace> readCostTrace(const std::string& path);
void writeCostTrace(const CostTrace& trace, std::ostream& out);

} // namespace mural::simulation
