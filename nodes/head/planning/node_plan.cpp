#include "nodes/head/planning/node_plan.hpp"

#include <algorithm>

#include "nodes/head/planning/codec_choice.hpp"
#include "nodes/head/planning/composition_choice.hpp"
#include "nodes/head/planning/tile_split.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"
#include "nodes/session/stream_build.hpp"

namespace mural {
namespace {

constexpr int kMaxLocalByDefault = 4;

std::string countOf(int count, const char* one) { return std::to_string(count) + " " + one + (count == 1 ? "" : "s"); }

std::string describeRegion(const NodePlan& plan) {
    const TileRegion& r = plan.region;
    const std::string pass = describe(plan.pass);
    return "node " + std::to_string(plan.node) + " (" + plan.where + ") draws " + (pass.empty() ? "" : pass + ": ") +
           countOf(r.columns * r.rows, "tile") + ": columns " + std::to_string(r.column) + " to " +
           std::to_string(r.column + r.columns - 1) + ", rows " + std::to_string(r.row) + " to " +
           std::to_string(r.row + r.rows - 1) + " (row 0 is the lowest)";
}

// Returns the number of node processes of a pass. The first passes get one more if the division has a remainder.
int nodesOfPass(int nodes, int passes, int pass) { return nodes / passes + (pass < nodes % passes ? 1 : 0); }

} // namespace

NodeReach reachOf(const std::string& host, const std::string& ownHost) {
    const bool here = host == "localhost" || host == "127.0.0.1" || host == ownHost;
    return here ? NodeReach::Tcp : NodeReach::LaunchCommand;
}

SessionPlan planSession(const SessionConfig& config, const std::string& ownHost) {
    const int tiles = config.columns * config.rows;
    const int ranges = config.passes.ranges;
    const std::vector<RenderPass> passes = passesOf(config.passes);
    const auto passCount = static_cast<int>(passes.size());
    int localNodes = config.localNodes;
    if (localNodes == 0 && config.hosts.empty())
        localNodes = std::max(passCount * ranges, std::min(tiles, kMaxLocalByDefault));
    const int requested = localNodes + static_cast<int>(config.hosts.size());
    const int wanted = std::max(requested, passCount * ranges);
    const int count = std::min(wanted, tiles * passCount * ranges);

    SessionPlan plan;
    plan.wall = compositionOf(config.passes);
    plan.nodesShowWall = passCount == 1;
    for (int p = 0; p < passCount; ++p) {
        const int parts = std::max(1, nodesOfPass(count / ranges, passCount, p));
        for (const TileRegion& region : splitGrid(config.columns, config.rows, parts)) {
            const auto collector = static_cast<int>(plan.nodes.size());
            for (int range = 0; range < ranges; ++range) {
                NodePlan node;
                node.node = static_cast<int>(plan.nodes.size());
                node.where = "local";
                node.pass = passes[static_cast<size_t>(p)];
                node.pass.range = range;
                node.pass.share = {static_cast<double>(range) / ranges, static_cast<double>(range + 1) / ranges};
                node.picture = pictureOf(config.passes, node.pass);
                node.answers = node.picture == 0 && range == 0;
                node.region = region;
                node.collector = collector;
                if (plan.nodesShowWall) node.swapBarrier = "barrier";
                const int machine = node.node % requested; // with more passes than nodes, each machine runs several
                if (machine >= localNodes) {
                    node.where = config.hosts[static_cast<size_t>(machine - localNodes)];
                    node.reach = reachOf(node.where, ownHost);
                }
                plan.explain.push_back(describeRegion(node));
                plan.nodes.push_back(node);
            }
        }
    }
    chooseComposition(plan, config.composition);
    chooseCodecs(plan, config.codec);
    const auto started = static_cast<int>(plan.nodes.size());
    if (wanted > started) {
        plan.warnings.push_back(countOf(wanted, "render node") + " requested, but there " +
                                (tiles == 1 ? "is " : "are ") + countOf(tiles, "tile") + ": only " +
                                countOf(started, "node") + " started; choose more --tiles");
    }
    return plan;
}

bool headShowsWall(const SessionConfig& config, const SessionPlan& plan) {
    return config.display == Display::Windows && !plan.nodesShowWall;
}

bool headShowsCanvas(const SessionConfig& config, const CanvasPlan& canvas) {
    return config.display == Display::App || (config.display == Display::Windows && !canvas.nodesShowWall);
}

bool headTakesPictures(const SessionConfig& config, const SessionPlan& plan) {
    return config.display == Display::App || !config.out.empty() || !config.sends.empty() ||
           headShowsWall(config, plan) ||
           std::ranges::any_of(plan.canvases, [&](const CanvasPlan& c) { return headShowsCanvas(config, c); });
}

bool showsWall(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node) {
    const bool nodesShow =
        node.canvas == 0 ? plan.nodesShowWall : plan.canvases[static_cast<size_t>(node.canvas) - 1].nodesShowWall;
    // only the collector has the picture
    return config.display == Display::Windows && nodesShow && node.pass.range == 0;
}

std::vector<const NodePlan*> swapMembersOf(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node) {
    std::vector<const NodePlan*> members;
    if (node.swapBarrier.empty() || !showsWall(config, plan, node)) return members;
    for (const NodePlan& other : plan.nodes)
        if (!other.isVacant && other.swapBarrier == node.swapBarrier && showsWall(config, plan, other))
            members.push_back(&other);
    if (members.size() < 2) members.clear();
    return members;
}

namespace {

// Returns true if the node's pixels reach the program's window unchanged: without scaling, averaging or a lossy codec.
bool keepsPixels(const SessionPlan& plan, const NodePlan& node) {
    const RenderPass& p = node.pass;
    const bool scales = !node.transferScale.none() || node.shown || node.movesZoom || !p.zoom.none() || !p.shown.none();
    return picturesOf(plan.wall) == 1 && plan.wall.copies.empty() && plan.canvases.empty() && !scales &&
           !mayLose(node.pictureCodec);
}

// True if `other` draws, on the machine of the node.
bool shareMachine(const NodePlan& other, const NodePlan& node) {
    const bool bothHere = other.reach != NodeReach::LaunchCommand && node.reach != NodeReach::LaunchCommand;
    return !other.isVacant && (bothHere || (other.reach == node.reach && other.where == node.where));
}

// The nodes of a machine take its GPUs, or the named ones, in turn.
void chooseGpu(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node, NodeSetup& setup) {
    int turn = 0, turns = 0;
    for (const NodePlan& other : plan.nodes) {
        if (!shareMachine(other, node)) continue;
        if (other.node < node.node) ++turn;
        ++turns;
    }
    const std::string first = config.gpus.empty() ? "auto" : config.gpus.front();
    if (first == "first") return;
    if (first == "auto") {
        setup.gpuTurn = turn;
        setup.gpuTurns = std::max(turns, 1);
        return;
    }
    setup.gpu = config.gpus[static_cast<size_t>(turn) % config.gpus.size()];
}

} // namespace

NodeSetup setupOf(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node) {
    NodeSetup setup;
    setup.node = node.node;
    setup.nodeCount = static_cast<int>(plan.nodes.size());
    setup.columns = config.columns;
    setup.rows = config.rows;
    setup.regionColumn = node.region.column;
    setup.regionRow = node.region.row;
    setup.regionColumns = node.region.columns;
    setup.regionRows = node.region.rows;
    setup.hasArea = node.area.has_value();
    setup.area = node.area.value_or(Viewport{});
    setup.anyMovesZoom = std::ranges::any_of(plan.nodes, &NodePlan::movesZoom);
    setup.movesZoom = node.movesZoom;
    if (followsAssignments(node))
        for (const NodePlan& other : plan.nodes) {
            const Viewport area = other.area.value_or(Viewport{});
            setup.areas.insert(setup.areas.end(), {area.x, area.y, area.w, area.h});
        }
    setup.sharesMachine = std::ranges::any_of(
        plan.nodes, [&](const NodePlan& other) { return other.node != node.node && shareMachine(other, node); });
    chooseGpu(config, plan, node, setup);
    setup.pass = node.pass;
    setup.transferScale = node.transferScale;
    setup.screen = node.screen;
    setup.collector = node.collector;
    if (node.pass.ranges > 1)
        for (const NodePlan& other : plan.nodes) // in the order of their ranks
            if (!other.isVacant && other.collector == node.collector && other.pass.ranges > 1)
                setup.ranges.insert(setup.ranges.end(), {other.pass.share.start, other.pass.share.end});
    setup.composition = nameOf(node.composition.value_or(compositor::Strategy::Serial));
    setup.pictureCodec = node.pictureCodec;
    setup.windowPixels = config.display == Display::App;
    setup.deepPictures = setup.windowPixels && keepsPixels(plan, node);
    setup.partCodec = node.codec;
    setup.readback = config.readback;
    setup.answers = node.answers;
    setup.exchangeHere = std::none_of(plan.nodes.begin(), plan.nodes.end(), [&](const NodePlan& other) {
        return !other.isVacant && other.collector == node.collector && other.reach == NodeReach::LaunchCommand;
    });
    setup.eyeBase = config.eyeBase;
    setup.focusDistance = config.focusDistance;
    setup.tiling = config.tiling;
    setup.culling = config.culling;
    setup.glBackend = config.glBackend;
    setup.sendPictures = headTakesPictures(config, plan);
    setup.wallWindows = showsWall(config, plan, node);
    setup.windowInput = setup.wallWindows && config.windowInput != input::InputPermission::Off;
    if (const auto members = swapMembersOf(config, plan, node); !members.empty()) {
        setup.swapMembers = static_cast<int>(members.size());
        setup.swapRank = static_cast<int>(std::ranges::find(members, node.node, &NodePlan::node) - members.begin());
        setup.swapLeader = members.front()->node;
        setup.swapHere =
            std::ranges::none_of(members, [](const NodePlan* m) { return m->reach == NodeReach::LaunchCommand; });
    }
    const NodeWindow window = node.window.value_or(NodeWindow{});
    setup.windowTitle = window.title;
    setup.windowAsOnWall = window.asOnWall;
    setup.fullScreen = config.fullScreen || window.fullScreen;
    setup.windowX = config.windowX + window.x;
    setup.windowY = config.windowY + window.y;
    const CanvasMillimetres size =
        node.canvas == 0 ? plan.size : plan.canvases[static_cast<size_t>(node.canvas) - 1].size;
    setup.wallWidthMm = size.width;
    setup.wallHeightMm = size.height;
    setup.placeThreads = config.placeThreads;
    setup.displayName = window.displayName.empty() ? config.displayName : window.displayName;
    setup.build = streamBuild();
    return setup;
}

} // namespace mural
