#include "nodes/head/planning/composition_choice.hpp"

#include "compositor/strategies/choose_strategy.hpp"

namespace mural {

void chooseComposition(SessionPlan& plan, const std::string& name) {
    const auto requested = compositor::strategyNamed(name);
    for (NodePlan& node : plan.nodes) {
        const int ranges = node.pass.ranges;
        if (ranges < 2) continue;
        // All nodes of one picture use the schedule of the first node.
        if (node.pass.range != 0) {
            node.composition = plan.nodes[static_cast<size_t>(node.collector)].composition;
            continue;
        }
        const bool chosen = requested || node.composition;
        if (requested)
            node.composition = requested;
        else if (!node.composition)
            node.composition = compositor::chooseStrategy(ranges);
        plan.explain.push_back("nodes " + std::to_string(node.node) + " to " + std::to_string(node.node + ranges - 1) +
                               " composite their picture with " + nameOf(*node.composition) +
                               (chosen ? ", as requested" : std::string(": ") + compositor::whyStrategy(ranges)));
    }
}

} // namespace mural
