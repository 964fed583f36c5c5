// Totals of an equalizer in a session, for reports and the status.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace mural {

struct EqualizerTotals {
    std::string id;
    std::string kind;    // keyword of the format, or "cost_map"
    bool ranges = false; // divides ranges of draws; otherwise areas of the picture
    bool frozen = false;
    std::string decision;  // the latest one
    int64_t frames = 0;    // measured frames
    int64_t moves = 0;     // decisions that changed a part
    int64_t taken = 0;     // frames drawn with other parts than the previous one
    double efficiency = 0; // total busy time / (nodes * longest busy time), mean of the last 32 measured frames
    std::vector<std::pair<std::string, std::string>> parameters; // name and value
    std::vector<std::pair<int, double>> nodes;                   // node and its part of the area or range
};

} // namespace mural
