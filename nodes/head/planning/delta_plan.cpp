#include "nodes/head/planning/delta_plan.hpp"

namespace mural {

DeltaPlan planDelta(const SessionConfig& config, const SessionPlan& plan,
                    const std::function<bool(int node)>& byMulticast) {
    DeltaPlan result;
    for (const NodePlan& node : plan.nodes) {
        const bool far = node.reach == NodeReach::LaunchCommand || byMulticast(node.node);
        if (config.delta == DeltaMode::On || (config.delta == DeltaMode::Auto && far))
            result.nodes.push_back(node.node);
    }
    const size_t count = result.nodes.size();
    if (count > 0)
        result.explain = "delta coding on for " + std::to_string(count) + (count == 1 ? " node" : " nodes") +
                         ": data is sent once; the cache in the head and in each of them has up to " +
                         std::to_string(config.cacheBytes >> 20) + " MiB";
    else if (config.delta == DeltaMode::Off)
        result.explain = "delta coding off: all nodes receive all calls unchanged";
    else
        result.explain = "delta coding off: all nodes are on this machine, where shared memory is faster; --delta on "
                         "enables it";
    return result;
}

} // namespace mural
