// Draws efficiencies over frames as SVG.
#pragma once

#include <string>
#include <vector>

namespace mural::cli {

struct EfficiencyCurve {
    std::string name;
    std::vector<double> values; // per frame, 0 to 1
    double mean = 0;
};

std::string efficiencyPlot(const std::string& title, const std::vector<EfficiencyCurve>& curves);

} // namespace mural::cli
