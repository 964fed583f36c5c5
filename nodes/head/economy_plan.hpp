// Which nodes are spared what they have had (economy/), as the user's --economy says. Pure.
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

// All that get the stream by multicast get the same.
EconomyPlan planEconomy(const SessionConfig& config, const SessionPlan& plan, const std::function<bool(int node)>& byMulticast);

} // namespace mural
