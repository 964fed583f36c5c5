// Which nodes a session has, where they run and what each draws. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/tile_grid.hpp"
#include "compositor/strategies/strategy.hpp"
#include "nodes/head/wall_composition.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

enum class NodeReach {
    SharedMemory, // a process of this machine
    Tcp,          // a process of this machine, as if it ran on another
    LaunchCommand // a process of another machine
};

// Where a node shows its own part of the wall, on its machine.
struct NodeWindow {
    std::string title;
    std::string displayName; // empty: the session's
    bool asOnWall = true;    // its place on the screen is that on the wall; else:
    int x = 0, y = 0;        // of its upper left corner
    bool fullScreen = false;
};

// Tiles of one picture, or of a part of it, that nodes take by when they are free.
struct TileQueuePlan {
    std::string name;
    Viewport area;           // of the picture: what is divided into them
    int width = 0, height = 0; // of a tile, pixels; the last ones of rows and columns may be smaller
};

// Runs of a picture's draws, in their order, that nodes take by when they are free.
struct ChunkQueuePlan {
    std::string name;
    Range range;     // of all draws: what is divided into them
    double part = 1; // of that, each
};

// A canvas that is shown beside the first one: the same picture, in pixels of its own.
struct CanvasPlan {
    std::string name;
    WallComposition wall;
    bool nodesShowWall = true; // as of SessionPlan
    Zoom shown;                // its size, to the program's picture
    int offsetX = 0;           // of its windows where those of all canvases lie on one screen
};

struct NodePlan {
    int node = 0;
    int canvas = 0; // 0: the first; others are SessionPlan::canvases[canvas - 1]
    std::string where; // "local" or the host
    NodeReach reach = NodeReach::SharedMemory;
    RenderPass pass;
    int picture = 0; // of the pass: see WallPart
    bool answers = true; // what programs read of windows
    TileRegion region;
    std::optional<Viewport> area; // instead of tiles: of the picture
    std::optional<Viewport> shown; // where the wall shows its area, if not there
    Zoom way; // its pictures travel smaller by this, at most 1; as large as they are shown they are made by who shows them
    int chunkQueue = -1; // its share of the draws moves by this one of SessionPlan::chunkQueues; -1: it stays
    int queue = -1; // its area moves by this one of SessionPlan::queues; -1: it stays
    std::optional<ScreenView> screen; // of a room
    std::optional<NodeWindow> window; // instead of those of tiles
    std::string swapBarrier; // windows that this node shows wait for those of other nodes with the same one; empty: for none
    int collector = 0; // the node that has the picture of all ranges: this one, when range is 0; range r is node collector + r
    std::string codec = "auto";        // of its pictures, to whomever; before chooseCodecs: what a file says
    std::string pictureCodec = "raw";  // of those that go to the head
    std::optional<compositor::Strategy> composition; // how they put it together; before chooseComposition: what a file says
};

struct SessionPlan {
    std::vector<NodePlan> nodes;
    std::vector<TileQueuePlan> queues;
    std::vector<ChunkQueuePlan> chunkQueues;
    WallComposition wall;
    bool nodesShowWall = true; // what each draws is a part of the wall's picture as it is
    std::vector<CanvasPlan> canvases; // that are shown, too
    std::optional<double> eyeBase, focusDistance; // that a configuration file says, in metres
    std::vector<std::string> explain; // lines for --explain
    std::vector<std::string> warnings; // lines that every user should see
};

// ownHost: this machine's name.
// A node on this machine, or how another one is reached; the same name as the user gave.
NodeReach reachOf(const std::string& host, const std::string& ownHost);

SessionPlan planSession(const SessionConfig& config, const std::string& ownHost);

// Where a session can't move areas, nodes keep those that they begin with; a line of the plan says why. After planSession(), or planOf().
void settleQueues(SessionPlan& plan, const SessionConfig& config);

// --display windows: whether the head opens one, with the whole wall, as only several pictures together make it.
[[nodiscard]] bool headShowsWall(const SessionConfig& config, const SessionPlan& plan);
// The same for a canvas beside the first; those have no window of the program's.
[[nodiscard]] bool headShowsCanvas(const SessionConfig& config, const CanvasPlan& canvas);
// Whether nodes send it what they draw.
[[nodiscard]] bool headTakesPictures(const SessionConfig& config, const SessionPlan& plan);

// Whether it opens windows for what it draws.
[[nodiscard]] bool showsWall(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node);

// The nodes of its swap barrier, itself among them, the leader first; none: its windows wait for nobody.
[[nodiscard]] std::vector<const NodePlan*> swapMembersOf(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node);

NodeSetup setupOf(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node);

} // namespace mural
