// The user's choices for the plan of a configuration file.
#pragma once

#include <string>
#include <vector>

#include "balancer/equalizers/balance.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

struct PlanOptions {
    std::string ownHost;
    bool allLocal = false; // all nodes on this machine
    std::string canvas;    // name of the canvas to show; empty: all that show something
    // names of the layouts to show; a canvas without any of them shows its first layout
    std::vector<std::string> layouts;
    ProjectionChoice projection = ProjectionChoice::Auto;
    double modelUnit = 1; // units of the program per metre of the file
    int width = 0;        // of the program's picture in pixels; 0: as in the file
    balance::Balance balance = balance::Balance::AsInFile;
};

} // namespace mural
