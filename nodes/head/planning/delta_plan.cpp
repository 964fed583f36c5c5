#include "nodes/head/planning/delta_plan.hpp"

namespace mural {

DeltaPlan planEconomy(const SessionConfig& config, const SessionPlan& plan,
                      const std::function<bool(int node)>& byMulticast) {
    DeltaPlan result;
    for (const NodePlan& node : plan.nodes) {
        const bool far = node.reach == NodeReach::LaunchCommand || byMulticast(node.node);
        if (config.economy == Economy::On || (config.economy == Economy::Auto && far))
            result.nodes.push_back(node.node);
    }
    const size_t count = result.nodes.size();
    if (count > 0)
        result.explain = "economy on for " + std::to_string(count) + (count == 1 ? " node" : " nodes") +
                         ": what they have had is not sent again; the head and each of them keep up to " +
                         std::to_string(config.storeBytes >> 20) + " MiB of it";
    else if (config.economy == Economy::Off)
        result.explain = "economy off: all nodes are sent all calls as they are";
    else
        result.explain = "economy off: all nodes are on this machine, where memory is faster than looking for what "
                         "they have had; --economy on turns it on";
    return result;
}

} // namespace mural
