// Which nodes a session has, where they run and what each draws. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/tile_grid.hpp"
#include "nodes/head/wall_composition.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

enum class NodeReach {
    SharedMemory, // a process of this machine
    Tcp,          // a process of this machine, as if it ran on another
    LaunchCommand // a process of another machine
};

struct NodePlan {
    int node = 0;
    std::string where; // "local" or the host
    NodeReach reach = NodeReach::SharedMemory;
    RenderPass pass;
    int picture = 0; // of the pass: see WallPart
    bool answers = true; // what programs read of windows
    TileRegion region;
    std::optional<Viewport> area; // instead of tiles: of the picture
    std::optional<ScreenView> screen; // of a room
    int collector = 0; // the node that puts the ranges of this picture together: this one, when range is 0
};

struct SessionPlan {
    std::vector<NodePlan> nodes;
    WallComposition wall;
    std::optional<double> eyeBase, focusDistance; // that a configuration file says, in metres
    std::vector<std::string> explain; // lines for --explain
    std::vector<std::string> warnings; // lines that every user should see
};

// ownHost: this machine's name.
// A node on this machine, or how another one is reached; the same name as the user gave.
NodeReach reachOf(const std::string& host, const std::string& ownHost);

SessionPlan planSession(const SessionConfig& config, const std::string& ownHost);

NodeSetup setupOf(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node);

} // namespace mural
