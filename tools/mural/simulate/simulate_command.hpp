// mural simulate: the balancing of a session, driven by cost traces in place of render nodes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace mural::cli {

struct SimulateArguments {
    std::string config; // empty: a generated one
    std::string cost;   // a file, or the name of a scene
    std::vector<std::string> layouts;
    int nodes = 8;
    std::string mode = "2d";
    int latency = 1;
    double noise = .03;
    std::vector<double> speeds;
    double overlap = 0;
    double assembly = 0;
    int frames = 100;
    uint32_t seed = 1;
    int seeds = 1;
    std::string equalizer = "costmap";
    bool compare = false;
    bool list = false;
    bool json = false;
    std::string plot;
    std::string write; // the trace
};

void describeSimulate(CLI::App& command, SimulateArguments& arguments);
int simulateCommand(const SimulateArguments& arguments);

extern const char* const kSimulateFooter;

} // namespace mural::cli
