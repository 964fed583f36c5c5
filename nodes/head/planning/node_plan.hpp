// The plan of a session: its nodes, their places, and the task of each node. Pure.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "balancer/compound/frame_input.hpp"
#include "balancer/equalizers/balance.hpp"
#include "common/geometry/tile_grid.hpp"
#include "compositor/strategies/strategy.hpp"
#include "nodes/head/frames/wall_composition.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

enum class NodeReach {
    SharedMemory, // a process of this machine
    Tcp,          // a process of this machine that is treated as remote
    LaunchCommand // a process of another machine
};

// The window in which a node shows its part of the wall, on its machine.
struct NodeWindow {
    std::string title;
    std::string displayName; // empty: the session's
    bool asOnWall = true;    // its position on the screen equals that on the wall; otherwise x, y
    int x = 0, y = 0;        // upper left corner
    bool fullScreen = false;
};

// The draw task of a node in the compound tree: the key of its render context.
struct DrawTask {
    compound::Index compound = config::kNone, destination = config::kNone, view = config::kNone;
    Eye eye = Eye::Cyclop;
};

// The configuration of a session and the equalizers that run in it.
struct BalancePlan {
    config::ResolvedConfig config;
    compound::FrameInput input;     // of the first frame
    compound::PixelSize wall{0, 0}; // size of the first canvas in `input`; 0 x 0: unknown
    balance::Balance choice = balance::Balance::AsInFile;
    std::vector<std::string> equalizers; // ids of those that nodes can follow; set by settleBalance()
};

// The size of a canvas in the room, in mm. 0: the configuration has none.
struct CanvasMillimetres {
    double width = 0, height = 0;
};

// A canvas beside the first: the same picture at its own resolution.
struct CanvasPlan {
    std::string name;
    WallComposition wall;
    bool nodesShowWall = true; // see SessionPlan
    Zoom shown;                // its size relative to the program's picture
    CanvasMillimetres size;
    int offsetX = 0; // horizontal offset of its windows if the windows of all canvases share one screen
};

struct NodePlan {
    int node = 0;
    bool isVacant = false; // no node: an earlier or later plan of the session uses this number
    int canvas = 0;        // 0: the first; n: SessionPlan::canvases[n - 1]
    std::string where;     // "local" or the host
    NodeReach reach = NodeReach::SharedMemory;
    RenderPass pass;
    int picture = 0;     // index of the picture within the pass (WallPart)
    bool answers = true; // answers reads of windows
    TileRegion region;
    std::optional<Viewport> area;  // on the picture, instead of tiles
    std::optional<Viewport> shown; // place on the wall, if different from area
    Zoom transferScale; // scale of its pictures in transfer, at most 1; the receiver scales them to their shown size
    std::optional<DrawTask> task;  // empty: a node of options without equalizers
    bool isPlacedByFrames = false; // frames of the file crop, move or scale its picture
    // equalizers change its area, range or zoom; set by settleBalance(). Nodes of one collector have one area.
    bool movesArea = false, movesRange = false, movesZoom = false;
    std::optional<ScreenView> screen; // for a screen in a room
    std::optional<NodeWindow> window; // replaces the windows of tiles
    std::string swapBarrier;          // swap barrier of the node's windows; empty: none
    // the node with the composited picture of all ranges, which has range 0; range r is node collector + r
    int collector = 0;
    std::string codec = "auto";       // codec of its pictures to other nodes; before chooseCodecs: the file's
    std::string pictureCodec = "raw"; // codec of its pictures to the head
    std::optional<compositor::Strategy> composition; // strategy of its group; before chooseComposition: the file's
};

// True if the node's part changes at a full clear of a window (HeadCommand::ViewportAssignment).
[[nodiscard]] inline bool followsAssignments(const NodePlan& node) { return node.movesArea || node.movesZoom; }

struct SessionPlan {
    std::vector<NodePlan> nodes;                // by number
    std::string canvas;                         // name of the first canvas; empty: none
    std::shared_ptr<const BalancePlan> balance; // null: nothing moves
    WallComposition wall;
    bool nodesShowWall = true;                    // each node draws an unscaled part of the wall
    CanvasMillimetres size;                       // of the first canvas
    std::vector<CanvasPlan> canvases;             // canvases beside the first
    std::optional<double> eyeBase, focusDistance; // from the configuration file, metres
    std::vector<std::string> explain;             // lines for --explain
    std::vector<std::string> warnings;            // lines for every user
};

// ownHost: this machine's name. Returns how the head reaches a node on `host`, as the user named it.
NodeReach reachOf(const std::string& host, const std::string& ownHost);

SessionPlan planSession(const SessionConfig& config, const std::string& ownHost);

// True if --display windows needs a window of the head, because several pictures compose the wall.
[[nodiscard]] bool headShowsWall(const SessionConfig& config, const SessionPlan& plan);
// The same for a canvas beside the first, which never uses the program's window.
[[nodiscard]] bool headShowsCanvas(const SessionConfig& config, const CanvasPlan& canvas);
// True if nodes send their pictures to the head.
[[nodiscard]] bool headTakesPictures(const SessionConfig& config, const SessionPlan& plan);

// True if the node opens windows for its pictures.
[[nodiscard]] bool showsWall(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node);

// The nodes of this node's swap barrier, including itself, the leader first. Empty: no barrier.
[[nodiscard]] std::vector<const NodePlan*> swapMembersOf(const SessionConfig& config, const SessionPlan& plan,
                                                         const NodePlan& node);

NodeSetup setupOf(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node);

} // namespace mural
