// Selects the nodes that receive a delta-coded stream (streamcodec/delta/), from the user's --delta. Pure.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nodes/head/planning/node_plan.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

struct DeltaPlan {
    std::vector<int> nodes;
    std::string explain; // for --explain
};

// All nodes of the multicast group receive the same encoding.
DeltaPlan planDelta(const SessionConfig& config, const SessionPlan& plan,
                    const std::function<bool(int node)>& byMulticast);

} // namespace mural
