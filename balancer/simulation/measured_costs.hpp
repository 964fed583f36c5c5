// Makes a cost trace from the work of render nodes that each drew one cell of the picture, or one part of the range.
// Pure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "balancer/simulation/cost_trace.hpp"
#include "common/base/result.hpp"

namespace mural::simulation {

// Seconds of each node, by frame.
using WorkByFrame = std::map<uint32_t, std::vector<double>>;

struct MeasuredRuns {
    size_t columns = 1, rows = 1;
    WorkByFrame whole;  // one node that drew everything
    WorkByFrame cells;  // columns * rows nodes, in the order of CostFrame::cells
    WorkByFrame ranges; // one node per part of the range, in ascending order
};

// Keeps for each frame and node the lesser time. Disturbances by other processes only lengthen a time. Frames that
// `other` lacks stay.
void keepLeastWork(WorkByFrame& least, const WorkByFrame& other);

// Replaces each time of a node by the median of `frames` neighbouring frames, an odd number. The noise of a measurement
// is large beside the cost of a small cell, and costs change slowly from frame to frame. A step stays in its frame.
void smoothOverTime(WorkByFrame& work, size_t frames);

// Uses the frames that all nodes of all runs have drawn. Work that each node does for any part counts once, so the
// cells of a frame, and the ranges, add up to the work of one node for the whole frame. Errors: the runs have no frame
// in common, or a frame without work.
Result<CostTrace> costsOf(const MeasuredRuns& runs, const std::string& name);

} // namespace mural::simulation
