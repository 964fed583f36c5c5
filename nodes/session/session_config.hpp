// The configuration of a session. `mural run` reads it from the command line and sends it to the head as one JSON line.
// Every field has the default of a run without options.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "balancer/equalizers/balance.hpp"
#include "common/base/result.hpp"
#include "common/geometry/viewport.hpp"
#include "nodes/input/input_permission.hpp"
#include "nodes/overlay/overlay_mode.hpp"
#include "nodes/session/culling_mode.hpp"
#include "nodes/session/readback.hpp"
#include "nodes/session/render_pass.hpp"
#include "nodes/session/screen_view.hpp"

namespace mural {

enum class Tiling { Exact, Culled, Lean };
enum class Display { None, App, Windows };
enum class LocalRendering { Off, On };
// The viewpoint of walls that a configuration file describes.
enum class ProjectionChoice {
    Auto,    // Room if screens stand at angles, otherwise Program
    Program, // all screens form one flat picture with the program's view
    Room     // each screen is seen from the observer's eyes
};
enum class DeltaMode { Auto, On, Off };

constexpr int kMaxLatency = 64;

struct SessionConfig {
    std::string session;    // abstract Unix socket name that programs connect to
    std::string socketPath; // the same socket's path, for programs in other network namespaces; empty: none
    int columns = 1;        // --tiles CxR
    int rows = 1;
    int tileWidth = 0, tileHeight = 0; // --tile-queue: tile size in pixels, replaces columns and rows; 0: no queue
    int chunks = 0; // --chunk-queue: number of chunks of a picture's draws, for nodes of --db; 0: fixed shares
    balance::Balance balance = balance::Balance::AsInFile; // --balance: the equalizers of areas and ranges
    int localNodes = 0;                  // --local-nodes; 0: min(columns * rows, 4) if there are no hosts
    std::vector<std::string> hosts;      // --nodes
    std::vector<std::string> spareHosts; // --spare-nodes: hosts that take over the nodes of a lost one, in this order
    std::vector<std::string> movedHosts; // "FROM=TO": nodes of FROM run on TO; one entry per replacement, in order
    std::string launchCommand = "ssh";   // --launch: ssh, slurm, pmix, or a command that runs a command on a host
    std::string launchSecret; // --secret: file with the secret of waiting nodes (@NAME) and remote walls; empty: none
    int64_t startTimeoutMs = 30'000;       // --start-timeout: for the connections of all nodes, then for their GL
    std::string stream = "auto";           // --stream: transport to other machines: auto, tcp, rsp://…
    DeltaMode delta = DeltaMode::Auto;     // --delta: delta coding
    int64_t cacheBytes = int64_t{1} << 30; // --cache-size: dictionary size, in each node and in the head
    int restartNodes = 3;                  // --restart-nodes: consecutive restarts of a lost node
    int minNodes = 0;                      // --min-nodes: number of nodes for the start, others may join later; 0: all
    std::string remoteMural;               // --remote-mural: path of mural on the hosts; empty: the local path
    // --node-program: the program with the native API that the nodes run; empty: the nodes replay captured programs
    std::string nodeProgram;
    std::string configFile;                               // --config; empty: the other options describe the wall
    bool allLocal = false;                                // --all-local: all nodes of the file run on this machine
    std::string canvas;                                   // --canvas
    std::vector<std::string> layouts;                     // --layout: layouts of the file's canvases
    ProjectionChoice projection = ProjectionChoice::Auto; // --projection
    double modelUnit = 1;                                 // --model-unit: program units per metre of the file
    PassCounts passes;                                    // --stereo, --pixel, --subpixel, --dplex, --db, --zoom
    std::string codec = "auto";         // --codec: name of the codec of transferred pictures (nodes/frame_transfer)
    Readback readback = Readback::Auto; // --readback: transfer from GL to memory
    std::string composition = "auto";   // --composition: auto, or the name of a compositor::Strategy
    double eyeBase = 0.05;              // --eye-base: distance between the eyes, in the program's units
    double focusDistance = 1;           // --focus: distance at which both eyes converge, in the program's units
    Tiling tiling = Tiling::Exact;
    CullingMode culling = CullingMode::Off; // --culling
    Display display = Display::None;
    LocalRendering localRendering = LocalRendering::Off;
    std::string glBackend = "auto";         // --gl: auto, egl, osmesa, glx
    std::vector<std::string> gpus{"auto"};  // --gpus: auto, first, or names that the nodes of a machine take in turn
    int latency = 1;                        // credit: frames that the program may be ahead of the wall
    int verifyEvery = 0;                    // --verify[=n]
    int64_t frames = 0;                     // --frames; 0: until the program ends
    std::string out;                        // --out: folder (PNG) or video file; empty: none
    std::vector<int64_t> saveFrames;        // --save 1,30,90: saved frames; empty: all
    std::string record;                     // --record: file of the programs' streams; empty: none
    std::string frameTimes;                 // --frame-times: file of the nodes' work per frame; empty: none
    std::vector<std::string> sends;         // --send: remote walls (nodes/remote_wall/wall_target.hpp)
    int width = 0, height = 0;              // --size; 0: the program's size
    bool fullScreen = false;                // --fullscreen: wall windows without borders, one per monitor
    int windowX = 0, windowY = 0;           // --position of the wall's upper left corner
    OverlayMode overlay = OverlayMode::Off; // --overlay: drawn over the windows of the wall, at the start
    bool overlayInFiles = false;            // --overlay-in-files
    // --window-input: events of the wall windows for the program
    input::InputPermission windowInput = input::InputPermission::Private;
    bool placeThreads = true; // --no-placement turns it off
    bool explain = false;
    std::string displayName; // X display of the wall windows and of the program's window
};

const char* nameOf(Display display);

std::string toJson(const SessionConfig& config); // one line
Result<SessionConfig> sessionConfigFromJson(const std::string& line);

// The first message to a node (HeadCommand::Setup).
struct NodeSetup {
    int node = 0;
    int nodeCount = 1;
    int columns = 1, rows = 1;
    int regionColumn = 0, regionRow = 0, regionColumns = 1, regionRows = 1;
    bool hasArea = false; // the node draws `area` instead of tiles
    Viewport area;        // region of the picture
    // x, y, width, height of every node's area, if areas or this node's zoom change
    // (HeadCommand::ViewportAssignment); empty: fixed
    std::vector<double> areas;
    // zooms change with the areas (HeadCommand::ViewportAssignment): of any node, and of this one
    bool anyMovesZoom = false, movesZoom = false;
    RenderPass pass;
    bool sharesMachine = false;       // other nodes of the session run on the same machine
    std::optional<ScreenView> screen; // view of a screen in a room; null: a part of a flat wall with the program's view
    bool answers = true;              // programs read the window pixels of this pass
    double eyeBase = 0.05, focusDistance = 1; // see SessionConfig
    Tiling tiling = Tiling::Exact;
    CullingMode culling = CullingMode::Off;
    std::string glBackend = "auto";
    std::string gpu;               // name of its GPU (nodes/gl/gpu_choice.hpp); empty: by turn
    int gpuTurn = 0, gpuTurns = 1; // its number among the nodes of its machine that divide the GPUs; 1: the first GPU
    bool sendPictures = false;     // sends Picture messages to the head at every swap…
    std::string pictureCodec = "raw"; // …or PackedPicture messages, unless raw: a name for PlaneEncoder
    bool windowPixels = false;        // pictures go to the program's own window, so lossy codecs keep the alpha
    bool deepPictures = false;        // pictures keep 10 bits per channel; requires windowPixels
    Zoom transferScale;               // reduction for the transfer, at most 1 (nodes/frame_transfer/transfer_scale.hpp)
    Readback readback = Readback::Auto; // transfer from GL to memory
    std::string partCodec = "auto";     // codec for parts of pictures between nodes
    bool wallWindows = false;           // opens one window per tile
    std::string windowTitle;            // title of the window that shows `area`
    // window position: the place on the wall plus windowX and windowY; false: windowX and windowY only
    bool windowAsOnWall = true;
    bool fullScreen = false;
    int windowX = 0, windowY = 0;
    OverlayMode overlay = OverlayMode::Off;   // drawn over its windows
    bool windowInput = false;                 // sends the events of its windows
    double wallWidthMm = 0, wallHeightMm = 0; // size of its canvas; 0: unknown
    bool placeThreads = true;
    std::string displayName;
    std::string stream;       // rsp://…: group that carries the packets; empty: this connection does
    std::string streamSecret; // secret of that group, in hex
    bool delta = false;       // packets arrive in batches (streamcodec/delta/batch_head.hpp)
    int64_t cacheBytes = int64_t{1} << 30;
    // in resync: receives earlier commands; sends nothing about them until it is a member (HeadCommand::Activate)
    bool isResyncing = false;
    bool skipsFrames = false;   // with isResyncing: skips drawing until Synchronize
    bool recordsSpans = false;  // statistics are on: sends FrameSpans
    uint32_t incarnation = 0;   // number of restarts
    std::vector<double> ranges; // start and end of the share of every node of this picture, by rank; empty: one node
    int collector = 0; // node that composes this node's picture; the nodes of the ranges follow it, one per range
    std::string composition = "serial"; // name of the compositor::Strategy for that picture
    // in hex; for nodes that exchange parts of a picture or share a swap barrier; empty: none
    std::string exchangeSecret;
    bool exchangeHere = false; // all nodes with ranges of the picture run on this machine
    int swapMembers = 0;       // members of the swap barrier of its windows; 0: none
    int swapRank = 0;          // rank of this node in it; 0: the leader
    int swapLeader = 0;        // node number of the leader
    bool swapHere = false;     // all members run on this machine
    std::string build;         // streamBuild() of the head
    std::string log;           // MURAL_LOG of the head; empty: not set
};

std::string toJson(const NodeSetup& setup);
Result<NodeSetup> nodeSetupFromJson(const std::string& line);

} // namespace mural
