#include "nodes/head/planning/plan_change.hpp"

#include <algorithm>
#include <map>

namespace mural {

namespace {

const char* nameOfEnd(bool isHead) { return isHead ? "the head" : "the nodes"; }

// Returns why the outputs of the session cannot show the plan. Empty: they can.
std::string whyOutputsDiffer(const PlanInForce& inForce, const SessionConfig& config, const SessionPlan& wanted) {
    const SessionPlan &current = inForce.plan, &outputs = inForce.outputs;
    const std::string subject = "the new plan needs a new session: ";
    const bool isSameFile = !config.configFile.empty() && config.configFile == inForce.config.configFile;
    if (isSameFile && current.canvas != wanted.canvas)
        return subject + "the first canvas, \"" + current.canvas + "\", shows the program's picture and cannot be off";
    if ((current.wall.stereo == StereoMode::Quad) != (wanted.wall.stereo == StereoMode::Quad))
        return subject + "windows with a buffer for each eye are opened at the start only";
    for (const CanvasPlan& canvas : wanted.canvases) {
        const auto same = std::ranges::find(outputs.canvases, canvas.name, &CanvasPlan::name);
        if (same == outputs.canvases.end())
            return subject + "canvas \"" + canvas.name + "\" was off when the session began";
        if (headShowsCanvas(inForce.config, *same) != headShowsCanvas(config, canvas))
            return subject + nameOfEnd(headShowsCanvas(config, canvas)) + " would show canvas \"" + canvas.name +
                   "\", and not " + nameOfEnd(headShowsCanvas(inForce.config, *same));
    }
    return {};
}

// Returns true if nothing that the node does depends on other nodes of the plan.
bool drawsAlone(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node) {
    return !followsAssignments(node) && !node.movesRange && node.pass.ranges == 1 && node.pass.period == 1 &&
           swapMembersOf(config, plan, node).empty();
}

// Returns the setup of a node without its numbers, and without its GPU, which a kept node keeps.
std::string taskOf(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node) {
    NodeSetup setup = setupOf(config, plan, node);
    setup.node = setup.collector = 0;
    setup.nodeCount = 1;
    setup.gpu.clear();
    setup.gpuTurn = 0;
    setup.gpuTurns = 1;
    return toJson(setup) + " " + node.where + " " + std::to_string(static_cast<int>(node.reach));
}

NodePlan vacant(int number) {
    NodePlan node;
    node.node = node.collector = number;
    node.isVacant = true;
    node.area = Viewport{0, 0, 0, 0};
    node.answers = false;
    return node;
}

} // namespace

Result<PlanChange> changeOf(const PlanInForce& current, const SessionConfig& config, SessionPlan wanted,
                            const std::function<bool(int node)>& isMember, int firstNumber) {
    if (const std::string why = whyOutputsDiffer(current, config, wanted); !why.empty()) return Error{why};
    std::multimap<std::string, int> tasks; // of members, to their numbers
    for (const NodePlan& node : current.plan.nodes)
        if (!node.isVacant && isMember(node.node) && drawsAlone(current.config, current.plan, node))
            tasks.emplace(taskOf(current.config, current.plan, node), node.node);

    PlanChange change;
    std::vector<int> numbers; // of the nodes of the new plan
    int next = firstNumber;
    for (const NodePlan& node : wanted.nodes) {
        const auto same = drawsAlone(config, wanted, node) ? tasks.find(taskOf(config, wanted, node)) : tasks.end();
        const bool isKept = same != tasks.end();
        numbers.push_back(isKept ? same->second : next++);
        (isKept ? change.kept : change.joining).push_back(numbers.back());
        if (isKept) tasks.erase(same);
    }
    std::vector<NodePlan> nodes;
    for (int number = 0; number < next; ++number) nodes.push_back(vacant(number));
    for (NodePlan& node : wanted.nodes) {
        const int number = numbers[static_cast<size_t>(node.node)];
        node.collector = numbers[static_cast<size_t>(node.collector)];
        node.node = number;
        nodes[static_cast<size_t>(number)] = std::move(node);
    }
    for (const NodePlan& node : current.plan.nodes)
        if (!node.isVacant && nodes[static_cast<size_t>(node.node)].isVacant) change.leaving.push_back(node.node);
    change.plan = std::move(wanted);
    change.plan.nodes = std::move(nodes);
    return change;
}

} // namespace mural
