// Orders the tasks of each pipe. A pipe executes the tasks of all its channels one after the other. Tasks of one
// channel keep their order, and an assembly task follows the producers of its frames. Any topological order satisfies
// both.
#include <algorithm>
#include <queue>
#include <span>

#include "balancer/compound/planner.hpp"

namespace mural::compound {

namespace {

// Dependency graph of the tasks of all channels.
struct TaskGraph {
    std::vector<PipeStep> steps;
    std::vector<size_t> missing; // number of unfinished predecessors
    std::vector<size_t> makerOf; // producing task of each frame

    // overlaps: pairs of channels that draw into the same pixels; the first finishes before the second begins.
    TaskGraph(const FramePlan& plan, const std::vector<std::pair<size_t, size_t>>& overlaps)
        : makerOf(plan.frames.size(), SIZE_MAX) {
        std::vector<size_t> first(plan.channels.size());
        for (size_t c = 0; c < plan.channels.size(); ++c) {
            first[c] = steps.size();
            for (size_t t = 0; t < plan.channels[c].tasks.size(); ++t) {
                for (const Index f : plan.channels[c].tasks[t].outputs) makerOf[at(f)] = steps.size();
                steps.push_back({c, t});
            }
        }
        missing.resize(steps.size(), 0);
        for (size_t i = 0; i < steps.size(); ++i) {
            if (steps[i].task > 0) addEdge(i - 1, i);
            for (const FrameUse& use : taskOf(plan, i).inputs) {
                if (makerOf[at(use.frame)] != SIZE_MAX) addEdge(makerOf[at(use.frame)], i);
            }
        }
        for (const auto& [one, other] : overlaps)
            addEdge(first[one] + plan.channels[one].tasks.size() - 1, first[other]);
        sortEdges();
    }

    // Returns the successors of a task.
    [[nodiscard]] std::span<const size_t> next(size_t i) const {
        return std::span(successors).subspan(begins[i], begins[i + 1] - begins[i]);
    }

    [[nodiscard]] const PlannedTask& taskOf(const FramePlan& plan, size_t i) const {
        return plan.channels[steps[i].channel].tasks[steps[i].task];
    }

private:
    void addEdge(size_t from, size_t to) {
        edges.emplace_back(from, to);
        ++missing[to];
    }

    void sortEdges() {
        begins.assign(steps.size() + 1, 0);
        for (const auto& [from, to] : edges) ++begins[from + 1];
        for (size_t i = 0; i < steps.size(); ++i) begins[i + 1] += begins[i];
        successors.resize(edges.size());
        std::vector<size_t> place(begins.begin(), begins.end() - 1);
        for (const auto& [from, to] : edges) successors[place[from]++] = to;
    }

    std::vector<std::pair<size_t, size_t>> edges;
    std::vector<size_t> begins, successors; // successors of task i: from begins[i] to begins[i + 1]
};

// Returns the frames of one cycle among the unfinished tasks.
std::vector<Index> circleOf(const FramePlan& plan, const TaskGraph& graph, const std::vector<bool>& done) {
    // Walk from any unfinished task to an unfinished predecessor until a task repeats.
    std::vector<size_t> before(graph.steps.size(), SIZE_MAX);
    for (size_t i = 0; i < graph.steps.size(); ++i) {
        for (const size_t n : graph.next(i)) {
            if (!done[i] && !done[n]) before[n] = i;
        }
    }
    size_t one = 0;
    while (done[one]) ++one;
    for (size_t i = 0; i < graph.steps.size(); ++i) one = before[one];
    std::vector<Index> frames;
    size_t here = one;
    do {
        for (const FrameUse& use : graph.taskOf(plan, here).inputs) {
            if (graph.makerOf[at(use.frame)] == before[here]) {
                frames.push_back(use.frame);
                break;
            }
        }
        here = before[here];
    } while (here != one);
    return frames;
}

std::vector<std::pair<size_t, size_t>> overlapsOf(const ResolvedConfig& config, const FramePlan& plan,
                                                  const DisplaySizes& sizes) {
    std::vector<std::pair<size_t, size_t>> pairs;
    const auto channel = [&](size_t c) { return at(plan.channels[c].channel); };
    std::vector<std::pair<Index, size_t>> byWindow;
    byWindow.reserve(plan.channels.size());
    for (size_t c = 0; c < plan.channels.size(); ++c) byWindow.emplace_back(config.channels[channel(c)].window, c);
    std::sort(byWindow.begin(), byWindow.end());
    for (size_t i = 0; i < byWindow.size(); ++i) {
        for (size_t j = i + 1; j < byWindow.size() && byWindow[j].first == byWindow[i].first; ++j) {
            const size_t one = byWindow[i].second, other = byWindow[j].second;
            if (!intersect(sizes.channels[channel(one)], sizes.channels[channel(other)]).empty())
                pairs.emplace_back(one, other);
        }
    }
    return pairs;
}

// Returns false if no order exists; `circle` then holds the frames of a cycle.
bool order(const ResolvedConfig& config, FramePlan& plan, const std::vector<std::pair<size_t, size_t>>& overlaps,
           std::vector<Index>& circle) {
    TaskGraph graph(plan, overlaps);
    // Ready tasks; the one with the lowest index runs first.
    std::priority_queue<size_t, std::vector<size_t>, std::greater<>> ready;
    std::vector<bool> done(graph.steps.size(), false);
    for (size_t i = 0; i < graph.steps.size(); ++i) {
        if (graph.missing[i] == 0) ready.push(i);
    }
    plan.pipes.assign(config.pipes.size(), {});
    size_t count = 0;
    while (!ready.empty()) {
        const size_t i = ready.top();
        ready.pop();
        done[i] = true;
        ++count;
        const Index channel = plan.channels[graph.steps[i].channel].channel;
        plan.pipes[at(config.windows[at(config.channels[at(channel)].window)].pipe)].push_back(graph.steps[i]);
        for (const size_t n : graph.next(i)) {
            if (--graph.missing[n] == 0) ready.push(n);
        }
    }
    if (count == graph.steps.size()) return true;
    plan.pipes.clear();
    circle = circleOf(plan, graph, done);
    return false;
}

} // namespace

void orderTasks(const ResolvedConfig& config, const DisplaySizes& sizes, FramePlan& plan) {
    // Channels of the file precede the destination channels of their window.
    std::sort(plan.channels.begin(), plan.channels.end(),
              [](const ChannelPlan& a, const ChannelPlan& b) { return a.channel < b.channel; });
    std::vector<Index> circle;
    if (order(config, plan, overlapsOf(config, plan, sizes), circle)) return;
    plan.interleaved = order(config, plan, {}, circle);
    if (!plan.interleaved) plan.deadlock = circle;
}

} // namespace mural::compound
