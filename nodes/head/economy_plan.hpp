// Selects the nodes that receive a delta-coded stream (economy/), from the user's --economy. Pure.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nodes/head/node_plan.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

struct EconomyPlan {
    std::vector<int> nodes;
    std::string explain; // for --explain
};

// All nodes of the multicast group receive the same encoding.
EconomyPlan planEconomy(const SessionConfig& config, const SessionPlan& plan, const std::function<bool(int node)>& byMulticast);

} // namespace mural
