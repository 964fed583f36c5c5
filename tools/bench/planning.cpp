// Measures the planning of a frame: equalizers, plan and difference. Asserts the plans, not the times.
//
//   planning [--quick]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <vector>

#include "balancer/compound/even_split.hpp"
#include "balancer/planner/frame_planner.hpp"
#include "balancer/simulation/simulator.hpp"

using namespace mural;
using balance::Balance;
using balance::FramePlanner;
using balance::FrameStatistics;

namespace {

struct Case {
    const char* name;
    size_t nodes;
    config::SplitMode mode;
    Balance balance;
    bool isVarying;
    double limitMicroseconds; // the goal; 0: none
};

FrameStatistics statisticsOf(FramePlanner& planner, double place) {
    FrameStatistics statistics;
    statistics.frameNumber = planner.plan().frameNumber;
    for (const auto& channel : planner.plan().channels)
        for (const auto& task : channel.tasks) {
            if (task.kind != config::Task::Draw) continue;
            auto leaf = balance::leafOf(planner.plan().contexts[config::at(task.context)], planner.input().sizes);
            const double x = leaf.viewport.x + leaf.viewport.w / 2 - place;
            leaf.busySeconds =
                leaf.viewport.w * leaf.viewport.h * (leaf.range.end - leaf.range.start) * (1 / (.05 + x * x));
            statistics.leaves.push_back(leaf);
        }
    return statistics;
}

// Returns false if a plan is wrong.
bool measure(const Case& c, int frames) {
    const auto loaded = simulation::dividedConfig(c.nodes, c.mode);
    FramePlanner planner(loaded.resolved, compound::firstFrame(loaded.resolved),
                         balance::makeEqualizers(loaded.resolved, c.balance));
    std::vector<double> times;
    size_t changes = 0;
    for (int f = 0; f < frames; ++f) {
        const auto start = std::chrono::steady_clock::now();
        changes += planner.next().changes.size();
        const auto planned = std::chrono::steady_clock::now();
        const FrameStatistics statistics = statisticsOf(planner, c.isVarying ? f % 100 / 100. : .3);
        const auto known = std::chrono::steady_clock::now();
        planner.addStatistics(statistics);
        const auto end = std::chrono::steady_clock::now();
        const std::chrono::duration<double, std::micro> spent = (planned - start) + (end - known);
        times.push_back(spent.count());
        if (statistics.leaves.size() < c.nodes / 2) {
            std::fprintf(stderr, "planning: %s: only %zu of %zu nodes draw\n", c.name, statistics.leaves.size(),
                         c.nodes);
            return false;
        }
    }
    std::sort(times.begin(), times.end());
    const size_t contexts = planner.plan().contexts.size();
    std::printf("%-26s %8zu %10.1f %10.1f %10.1f %10.1f %12.1f\n", c.name, contexts, times[times.size() / 2],
                times[times.size() * 9 / 10], times.back(), c.limitMicroseconds, static_cast<double>(changes) / frames);
    return true;
}

} // namespace

int main(int count, char** arguments) {
    const bool isQuick = count > 1 && std::strcmp(arguments[1], "--quick") == 0;
    using config::SplitMode;
    const Case cases[] = {
        {"even, 30", 30, SplitMode::TwoD, Balance::Off, false, 50},
        {"cost map constant, 30", 30, SplitMode::TwoD, Balance::Auto, false, 50},
        {"cost map varying, 30", 30, SplitMode::TwoD, Balance::Auto, true, 50},
        {"load varying, 30", 30, SplitMode::TwoD, Balance::Load, true, 50},
        {"cost map db varying, 30", 30, SplitMode::Db, Balance::Auto, true, 50},
        {"even, 1000", 1000, SplitMode::TwoD, Balance::Off, false, 2000},
        {"cost map constant, 1000", 1000, SplitMode::TwoD, Balance::Auto, false, 2000},
        {"cost map varying, 1000", 1000, SplitMode::TwoD, Balance::Auto, true, 2000},
        {"load varying, 1000", 1000, SplitMode::TwoD, Balance::Load, true, 2000},
    };
    std::printf("%-26s %8s %10s %10s %10s %10s %12s\n", "case (us per frame)", "contexts", "median", "p90", "most",
                "goal", "changes");
    bool isRight = true;
    for (const Case& c : cases) isRight &= measure(c, isQuick ? 30 : 300);
    return isRight ? 0 : 1;
}
