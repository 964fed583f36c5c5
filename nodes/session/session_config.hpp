// What the user asked for: filled from the command line by `mural run`, handed to the head as one
// JSON line. Every field has the default of a run without options.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "common/viewport.hpp"
#include "nodes/session/readback.hpp"
#include "nodes/session/render_pass.hpp"
#include "nodes/session/screen_view.hpp"

namespace mural {

enum class Tiling { Exact, Culled, Lean };
enum class Display { None, App, Windows };
enum class CapturePolicy { State, Full };
// Where walls are looked at from, with a configuration file.
enum class Frusta {
    Auto,    // from the room where screens stand at angles, else as the program does
    Program, // all screens as one flat picture, the program's
    Room     // each screen from the observer's eyes
};
enum class Economy { Auto, On, Off };

struct SessionConfig {
    std::string session;          // abstract Unix socket name that programs connect to
    std::string socketPath;       // the same socket's path, for programs in other network namespaces; empty: none
    int columns = 1;              // --tiles CxR
    int rows = 1;
    int tileWidth = 0, tileHeight = 0; // --tile-queue: pixels of tiles that nodes take from a queue, instead of columns and rows; 0: none
    int chunks = 0;               // --chunk-queue: into so many a picture's draws are cut, which nodes of --db take from a queue; 0: none, each has its share
    int localNodes = 0;           // --local-nodes; 0: min(columns * rows, 4) when there are no hosts
    std::vector<std::string> hosts; // --nodes
    std::string launchCommand = "ssh -o BatchMode=yes"; // --launch: prefix that runs a command on a host
    std::string stream = "auto";  // --stream: how it travels to other machines: auto, tcp, rsp://…
    Economy economy = Economy::Auto; // --economy: which nodes are not sent again what they have had
    int64_t storeBytes = int64_t{1} << 30; // --store: of that, in each of them and in the head
    int restartNodes = 3;         // --restart-nodes: how often in a row a lost node is started again
    int leastNodes = 0;           // --least-nodes: so many are enough to begin, the others may come later; 0: all
    std::string remoteMural;      // --remote-mural: path of mural on the hosts; empty: this one's path
    std::string configFile;       // --config; empty: what follows says it
    bool here = false;            // --here: all its nodes on this machine
    std::string canvas;           // --canvas
    std::vector<std::string> layouts; // --layout: of its canvases
    Frusta frusta = Frusta::Auto; // --frusta
    double modelUnit = 1;         // --model-unit: of the program, to the metre of the file
    PassCounts passes;            // --stereo, --pixel, --subpixel, --dplex, --db, --zoom
    std::string codec = "auto";   // --codec: how pictures of nodes travel: as of PlaneEncoder (nodes/pictures)
    Readback readback = Readback::Auto; // --readback: how they leave the nodes' GL
    std::string composition = "auto"; // --composition: auto, or a compositor::Strategy by its name
    double eyeBase = 0.05;        // --eye-base: distance of the eyes, in the program's units
    double focusDistance = 1;     // --focus: where both eyes see the same, in the program's units
    Tiling tiling = Tiling::Exact;
    Display display = Display::None;
    CapturePolicy policy = CapturePolicy::State;
    std::string glBackend = "auto"; // --gl: auto, egl, osmesa, glx
    int latency = 1;              // frames the program may be ahead of the wall
    int verifyEvery = 0;          // --verify[=n]
    int64_t frames = 0;           // --frames; 0: until the program ends
    std::string out;              // --out: folder (PNG) or video file; empty: none
    std::vector<int64_t> saveFrames; // --save 1,30,90: only these; empty: all
    std::string record;           // --record: file of the programs' streams; empty: none
    int width = 0, height = 0;    // --size; 0: the program's own
    bool fullScreen = false;      // --fullscreen: wall windows without borders, one per monitor
    int windowX = 0, windowY = 0; // --position of the wall's upper left corner
    bool placeThreads = true;     // --no-placement turns it off
    bool explain = false;
    std::string displayName;      // X display of the wall windows and of the app's window
};

const char* nameOf(Display display);

std::string toJson(const SessionConfig& config); // one line
Result<SessionConfig> sessionConfigFromJson(const std::string& line);

// What one node is told first (HeadCommand::Setup).
struct NodeSetup {
    int node = 0;
    int nodeCount = 1;
    int columns = 1, rows = 1;
    int regionColumn = 0, regionRow = 0, regionColumns = 1, regionRows = 1;
    bool hasArea = false;         // its part is not one of tiles, but
    Viewport area;                // this one of the picture
    std::vector<double> areas;    // that of every node, x, y, width, height, where they move (HeadCommand::Areas); empty: they don't
    RenderPass pass;
    bool sharesMachine = false;   // with other nodes of the session
    std::optional<ScreenView> screen; // of a room; else the part is one of a flat wall, seen as the program sees it
    bool answers = true; // what programs read of windows is this pass's
    double eyeBase = 0.05, focusDistance = 1; // see SessionConfig
    Tiling tiling = Tiling::Exact;
    std::string glBackend = "auto";
    bool sendPictures = false;    // Picture messages to the head at every swap…
    std::string pictureCodec = "raw"; // …or PackedPictures, as of PlaneEncoder
    bool windowPixels = false;    // pictures go to the program's own window: lossy codecs keep its alpha
    bool deepPictures = false;    // pictures keep 10 bits per channel; requires windowPixels
    Zoom way;                     // they are sent smaller by this, at most 1 (nodes/pictures/picture_way.hpp)
    Readback readback = Readback::Auto; // how they leave GL
    std::string partCodec = "auto"; // of parts of pictures, to other nodes
    bool wallWindows = false;     // open one window per tile
    std::string windowTitle;      // of the one that shows its area
    bool windowAsOnWall = true;   // its place on the screen is that on the wall, moved by windowX and windowY; else just there
    bool fullScreen = false;
    int windowX = 0, windowY = 0;
    bool placeThreads = true;
    std::string displayName;
    std::string stream;           // rsp://…: the group to join; its packets come there. Empty: on this connection
    std::string streamSecret;     // of that group, in hex
    bool economy = false;         // packets come in batches (economy/batch_head.hpp)
    int64_t storeBytes = int64_t{1} << 30;
    bool catchesUp = false;       // it is given what came before, and says nothing of it until it is a member (HeadCommand::Member)
    bool skipsFrames = false;     // with it: frames are not drawn until Synchronize says so
    uint32_t life = 0;            // how often it was started again
    int collector = 0;            // the node that has the picture that this one draws a range of; ranges follow it, one node each
    std::string composition = "serial"; // compositor::Strategy by which they put it together
    std::string exchangeSecret;   // of nodes that send each other parts of a picture, or wait for each other, in hex; empty: none do
    bool exchangeHere = false;    // all that draw ranges of its picture run on this machine
    int swapMembers = 0;          // of the swap barrier that its windows belong to; 0: none
    int swapRank = 0;             // its own among them; 0: the leader
    int swapLeader = 0;           // the leader's number
    bool swapHere = false;        // all members run on this machine
    std::string build;            // streamBuild() of the head
};

std::string toJson(const NodeSetup& setup);
Result<NodeSetup> nodeSetupFromJson(const std::string& line);

} // namespace mural
