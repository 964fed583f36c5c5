// Totals of an equalizer in a session, for reports and the status.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/viewport.hpp"

namespace mural {

// The parts among which an equalizer divides work. Frames: nodes draw whole frames in turn. Zooms: none; it changes the
// zoom of all its nodes.
enum class Division : uint8_t { Areas, Ranges, Frames, Zooms };

struct NodeShare {
    int node = 0;
    double part = 0;                               // of the area, range or frames
    std::optional<Viewport> area;                  // of the picture, for Division::Areas
    std::optional<double> measuredMs, predictedMs; // per frame with this part (PartPrediction)
};

struct EqualizerTotals {
    std::string id;
    std::string kind; // keyword of the format, or "cost_map"
    Division division = Division::Areas;
    bool frozen = false;
    std::string decision; // the latest one
    int64_t frames = 0;   // measured frames
    int64_t moves = 0;    // decisions that changed a part, a zoom or the pace
    int64_t taken = 0;    // frames drawn with other parts than the previous one
    // total busy time / (nodes * longest busy time), mean of the last 32 measured frames; 0 for Division::Frames and
    // Zooms
    double efficiency = 0;
    double framesPerSecond = 0; // highest rate of the program, for Division::Frames; 0: no limit
    double zoom = 0;            // announced zoom relative to the file, for Division::Zooms
    std::vector<std::pair<std::string, std::string>> parameters; // name and value
    std::vector<NodeShare> nodes;
};

} // namespace mural
