// The windows in which nodes show their own pictures. Pure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "nodes/head/planning/config/config_source.hpp"
#include "nodes/head/planning/node_plan.hpp"

namespace mural {

struct WindowInput {
    const ConfigSource& source;
    const compound::DisplaySizes& sizes;
    const std::vector<compound::Index>& channels;           // drawing channel per node
    const std::map<compound::Index, std::string>& barriers; // name of the swap barrier by window
    bool allLocal = false;                                  // all nodes on this machine
};

// Nodes show their own pictures if the file assigns a window to their channel, and one node draws each channel of the
// wall exactly as it is shown. Otherwise the head shows the wall: SessionPlan::nodesShowWall is false.
void placeWindows(const WindowInput& input, SessionPlan& plan);

} // namespace mural
