// Drives the frame planner of a session with the costs of a trace in place of render nodes. Deterministic.
#pragma once

#include "balancer/compound/load_config.hpp"
#include "balancer/equalizers/make_equalizers.hpp"
#include "balancer/simulation/cost_trace.hpp"

namespace mural::simulation {

enum class Strategy : uint8_t { Even, Load, LoadUndamped, Tree, CostMap, ExactMap, AsInFile };
inline constexpr Strategy kCompared[] = {Strategy::Even, Strategy::Load,    Strategy::LoadUndamped,
                                         Strategy::Tree, Strategy::CostMap, Strategy::ExactMap};
const char* nameOf(Strategy strategy);

struct Conditions {
    int latency = 1;                  // frames between a frame and the first plan that knows its times; from 1 on
    double noise = .03;               // standard deviation of a time, as a fraction
    std::vector<double> speeds;       // of the nodes, repeated as needed; empty: all 1
    double overlap = 0;               // part of the cost that belongs to objects, drawn by each node that they touch
    double assembly = 0;              // seconds of the destination per picture of a helper
    size_t frames = 100;              // the trace is repeated as needed
    std::vector<std::string> layouts; // shown ones (activateLayout()); canvases without any show their first
    uint32_t seed = 1;
};

struct Outcome {
    std::vector<double> efficiency; // per frame: sum of the times / (nodes * longest time), without noise
    std::vector<double> longest;    // per frame: longest time in s, without noise
    std::vector<double> travel;     // per frame: moved edges, as a fraction of the picture or the range, summed
    size_t leaves = 0;
    // Rectangles of the last frame, relative to the destination; for the plot.
    std::vector<Viewport> parts;
};

// Returns a configuration whose only compound divides a picture (2D) or a range among `nodes` nodes.
compound::LoadedConfig dividedConfig(size_t nodes, config::SplitMode mode);

// The costs of a trace are those of each view's area. The channels of a window draw one after the other, and count as
// one node: in a session, each window is a process.
//
// Returns the first problem of the conditions and the configuration; empty: none.
std::string problemOf(const config::ResolvedConfig& config, const CostTrace& trace, const Conditions& conditions);

// Requires problemOf() to be empty.
Outcome simulate(const config::ResolvedConfig& config, const CostTrace& trace, const Conditions& conditions,
                 Strategy strategy);

} // namespace mural::simulation
