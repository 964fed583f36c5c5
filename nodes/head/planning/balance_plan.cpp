#include "nodes/head/planning/balance_plan.hpp"

#include <algorithm>
#include <map>

#include "balancer/equalizers/make_equalizers.hpp"

namespace mural {

namespace {

using balance::Effect;
using compound::Index;
using config::at;
using config::kNone;

bool isBelow(const config::ResolvedConfig& config, Index compound, Index root) {
    for (; compound != kNone; compound = config.compounds[at(compound)].parent)
        if (compound == root) return true;
    return false;
}

bool drawsUnscaled(const NodePlan& node) {
    const RenderPass& p = node.pass;
    return p.kernelWidth * p.kernelHeight == 1 && p.zoom.none() && !node.shown && node.transferScale.none() &&
           !node.isPlacedByFrames;
}

// Returns why the areas of these nodes cannot move. Empty: they can.
std::string whyAreasAreFixed(const SessionPlan& plan, const SessionConfig& config, const std::vector<int>& nodes) {
    if (config.tiling == Tiling::Lean) return "--tiling lean gives each node a framebuffer of its first tiles' size";
    for (const int n : nodes) {
        const NodePlan& node = plan.nodes[static_cast<size_t>(n)];
        if (showsWall(config, plan, node)) return "nodes show their tiles in their own windows (--display windows)";
        if (node.pass.period > 1) return "its nodes draw whole frames in turn (--dplex)";
        if (!drawsUnscaled(node)) return "its nodes draw kernels, or zoomed or cropped parts";
    }
    return {};
}

// The nodes of one collector composite their ranges, so they have one area: that of the collector. How an equalizer
// affects them:
enum class AreaRole {
    Leads,   // it has the collectors of its nodes
    Follows, // it has none of them: the collectors' equalizer counts
    Mixed
};

AreaRole roleOf(const SessionPlan& plan, const std::vector<int>& nodes) {
    const auto hasCollector = [&](int n) {
        return std::ranges::find(nodes, plan.nodes[static_cast<size_t>(n)].collector) != nodes.end();
    };
    if (std::ranges::all_of(nodes, hasCollector)) return AreaRole::Leads;
    return std::ranges::none_of(nodes, hasCollector) ? AreaRole::Follows : AreaRole::Mixed;
}

// True if the equalizer divides one area among nodes that composite it: workers of a tile queue with ranges.
bool dividesGroups(const SessionPlan& plan, const balance::Equalizer& e, const std::vector<int>& nodes) {
    const config::ResolvedConfig& config = plan.balance->config;
    const std::vector<Index> targets = e.targets(config);
    const auto targetOf = [&](int n) {
        const NodePlan& node = plan.nodes[static_cast<size_t>(n)];
        const auto found =
            std::ranges::find_if(targets, [&](Index t) { return isBelow(config, node.task->compound, t); });
        return found == targets.end() ? kNone : *found;
    };
    std::map<int, Index> known; // target by collector
    return std::ranges::any_of(nodes, [&](int n) {
        const Index target = targetOf(n);
        return known.try_emplace(plan.nodes[static_cast<size_t>(n)].collector, target).first->second != target;
    });
}

// Returns the nodes and those that composite with them.
std::vector<int> withGroups(const SessionPlan& plan, const std::vector<int>& nodes) {
    std::vector<int> all;
    for (const NodePlan& node : plan.nodes)
        if (std::ranges::find(nodes, node.collector) != nodes.end() ||
            std::ranges::find(nodes, node.node) != nodes.end())
            all.push_back(node.node);
    return all;
}

std::string whyRangesAreFixed(const SessionPlan& plan, const std::vector<int>& nodes) {
    for (const int n : nodes) {
        const NodePlan& node = plan.nodes[static_cast<size_t>(n)];
        if (node.pass.period > 1) return "its nodes draw whole frames in turn (--dplex)";
        if (node.pass.ranges < 2) return "the ranges of its nodes have different areas";
    }
    return {};
}

// Returns why the zooms of these nodes cannot change. Empty: they can.
std::string whyZoomsAreFixed(const SessionPlan& plan, const std::vector<int>& nodes) {
    const auto isZoomed = [&](const NodePlan& node) { return std::ranges::find(nodes, node.node) != nodes.end(); };
    for (const NodePlan& node : plan.nodes) {
        if (!isZoomed(node)) continue;
        if (node.pass.period > 1) return "its nodes draw whole frames in turn (--dplex)";
        // pictures are composited by depth at their drawn size
        for (const NodePlan& other : plan.nodes)
            if (other.collector == node.collector && !isZoomed(other))
                return "it does not cover all ranges of a picture; set it in the compound above the ranges";
    }
    return {};
}

std::string listOf(const std::vector<int>& nodes) {
    std::string list;
    for (size_t i = 0; i < nodes.size(); ++i)
        list += (i == 0 ? "" : i + 1 == nodes.size() ? " and " : ", ") + std::to_string(nodes[i]);
    return list;
}

void settleUsage(SessionPlan& plan, const balance::Equalizer& e, bool isDivided, BalancePlan& into) {
    const std::string name = "equalizer \"" + e.id() + "\"";
    if (!isDivided) {
        plan.explain.push_back(name + " has no effect: no equalizer below it moves work between nodes");
        return;
    }
    into.equalizers.push_back(e.id());
    plan.explain.push_back(name + " (" + e.kind() +
                           ") lends nodes of cheap parts of the wall to expensive ones, through the equalizers below");
}

// Equalizers of usage act through equalizers of areas and ranges below them.
bool dividesBelow(const BalancePlan& balance, const std::vector<std::unique_ptr<balance::Equalizer>>& all, Index root) {
    return std::ranges::any_of(all, [&](const auto& e) {
        const bool runs = std::ranges::find(balance.equalizers, e->id()) != balance.equalizers.end();
        return runs && e->compound() != root && isBelow(balance.config, e->compound(), root);
    });
}

void settleDivision(SessionPlan& plan, const SessionConfig& config, const balance::Equalizer& e, BalancePlan& into) {
    const std::vector<int> nodes = nodesOf(plan, e);
    const bool ranges = e.effect() == Effect::Ranges;
    const std::string name = "equalizer \"" + e.id() + "\"";
    if (nodes.size() < 2) {
        plan.explain.push_back(name + " has no effect: " + (nodes.empty() ? "no node" : "one node") +
                               " of this session draws its part");
        return;
    }
    const AreaRole role = ranges ? AreaRole::Leads : roleOf(plan, nodes);
    if (role == AreaRole::Follows) {
        plan.explain.push_back(name + " (" + e.kind() +
                               ") has no parts of its own: nodes that composite one picture have the areas of its "
                               "first range");
        return;
    }
    const std::vector<int> moved = ranges ? nodes : withGroups(plan, nodes);
    const std::string why = ranges                          ? whyRangesAreFixed(plan, nodes)
                            : dividesGroups(plan, e, nodes) ? "its nodes draw ranges (--db)"
                            : role == AreaRole::Mixed       ? "it divides some first ranges of pictures and not all"
                                                            : whyAreasAreFixed(plan, config, moved);
    if (!why.empty()) {
        plan.warnings.push_back(name + ": " + (ranges ? "ranges" : "areas") + " stay fixed: " + why);
        return;
    }
    for (const int node : moved)
        (ranges ? plan.nodes[static_cast<size_t>(node)].movesRange : plan.nodes[static_cast<size_t>(node)].movesArea) =
            true;
    into.equalizers.push_back(e.id());
    plan.explain.push_back(name + " (" + e.kind() + ") divides the " + (ranges ? "draws" : "picture") +
                           " among nodes " + listOf(moved) + " by their times for the last frames");
}

void settlePace(SessionPlan& plan, const balance::Equalizer& e, BalancePlan& into) {
    std::vector<int> nodes = nodesOf(plan, e);
    std::erase_if(nodes, [&](int n) { return plan.nodes[static_cast<size_t>(n)].pass.period < 2; });
    const std::string name = "equalizer \"" + e.id() + "\"";
    if (nodes.size() < 2) {
        plan.explain.push_back(name + " has no effect: no nodes of its compound draw frames in turn");
        return;
    }
    into.equalizers.push_back(e.id());
    plan.explain.push_back(name + " (" + e.kind() + ") begins frames at equal intervals, by the times of nodes " +
                           listOf(nodes));
}

void settleZoom(SessionPlan& plan, const balance::Equalizer& e, BalancePlan& into) {
    const std::vector<int> nodes = nodesOf(plan, e);
    const std::string name = "equalizer \"" + e.id() + "\"";
    if (nodes.empty()) {
        plan.explain.push_back(name + " has no effect: no node of this session draws its part");
        return;
    }
    const std::string why = whyZoomsAreFixed(plan, nodes);
    if (!why.empty()) {
        plan.warnings.push_back(name + ": the zoom stays fixed: " + why);
        return;
    }
    for (const int node : nodes) plan.nodes[static_cast<size_t>(node)].movesZoom = true;
    into.equalizers.push_back(e.id());
    plan.explain.push_back(name + " (" + e.kind() + ") changes the zoom of " + (nodes.size() > 1 ? "nodes " : "node ") +
                           listOf(nodes) + " by the frame rate");
}

} // namespace

std::vector<int> nodesOf(const SessionPlan& plan, const balance::Equalizer& equalizer) {
    std::vector<int> nodes;
    if (!plan.balance) return nodes;
    const config::ResolvedConfig& config = plan.balance->config;
    for (const Index target : equalizer.targets(config))
        for (const NodePlan& node : plan.nodes)
            if (node.task && isBelow(config, node.task->compound, target)) nodes.push_back(node.node);
    return nodes;
}

void settleBalance(SessionPlan& plan, const SessionConfig& config) {
    if (!plan.balance) return;
    auto settled = std::make_shared<BalancePlan>(*plan.balance);
    const auto all = balance::makeEqualizers(settled->config, settled->choice);
    for (const auto& e : all)
        if (e->effect() == Effect::Viewports || e->effect() == Effect::Ranges)
            settleDivision(plan, config, *e, *settled);
        else if (e->effect() == Effect::FrameRates)
            settlePace(plan, *e, *settled);
        else if (e->effect() == Effect::Zooms)
            settleZoom(plan, *e, *settled);
        else if (e->effect() == Effect::Inputs) // places are fixed: placeMonitors()
            plan.explain.push_back("equalizer \"" + e->id() + "\" (" + e->kind() +
                                   ") places pictures of other channels by their parts of the view");
    for (const auto& e : all)
        if (e->effect() == Effect::Usage) settleUsage(plan, *e, dividesBelow(*settled, all, e->compound()), *settled);
    plan.balance = std::move(settled);
}

} // namespace mural
