#include "nodes/head/node_plan.hpp"

#include <algorithm>

#include "nodes/head/composition_choice.hpp"
#include "nodes/head/tile_split.hpp"
#include "nodes/session/stream_build.hpp"

namespace mural {
namespace {

constexpr int kMostLocalByDefault = 4;

std::string countOf(int count, const char* one) {
    return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string describeRegion(const NodePlan& plan) {
    const TileRegion& r = plan.region;
    const std::string pass = describe(plan.pass);
    return "node " + std::to_string(plan.node) + " (" + plan.where + ") draws " + (pass.empty() ? "" : pass + ": ") +
           countOf(r.columns * r.rows, "tile") + ": columns " + std::to_string(r.column) + " to " +
           std::to_string(r.column + r.columns - 1) + ", rows " + std::to_string(r.row) + " to " +
           std::to_string(r.row + r.rows - 1) + " (row 0 is the lowest)";
}

// Node processes for each of `passes`; the first passes get one more where it does not come out even.
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
    if (localNodes == 0 && config.hosts.empty()) localNodes = std::max(passCount * ranges, std::min(tiles, kMostLocalByDefault));
    const int asked = localNodes + static_cast<int>(config.hosts.size());
    const int wanted = std::max(asked, passCount * ranges);
    const int count = std::min(wanted, tiles * passCount * ranges);

    SessionPlan plan;
    plan.wall = compositionOf(config.passes);
    plan.nodesShowWall = passCount == 1;
    for (int p = 0; p < passCount; ++p) {
        for (const TileRegion& region : splitGrid(config.columns, config.rows, std::max(1, nodesOfPass(count / ranges, passCount, p)))) {
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
                const int place = node.node % asked; // more passes than nodes were given: several on each machine
                if (place >= localNodes) {
                    node.where = config.hosts[static_cast<size_t>(place - localNodes)];
                    node.reach = reachOf(node.where, ownHost);
                }
                plan.explain.push_back(describeRegion(node));
                plan.nodes.push_back(node);
            }
        }
    }
    chooseComposition(plan, config.composition);
    const auto started = static_cast<int>(plan.nodes.size());
    if (wanted > started) {
        plan.warnings.push_back(countOf(wanted, "render node") + " asked for, but there " +
                                (tiles == 1 ? "is " : "are ") + countOf(tiles, "tile") + ": only " +
                                countOf(started, "node") + " started; --tiles makes more tiles");
    }
    return plan;
}

bool headShowsWall(const SessionConfig& config, const SessionPlan& plan) { return config.display == Display::Windows && !plan.nodesShowWall; }

bool showsWall(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node) {
    return config.display == Display::Windows && plan.nodesShowWall && node.pass.range == 0; // the collector has the picture
}

std::vector<const NodePlan*> swapMembersOf(const SessionConfig& config, const SessionPlan& plan, const NodePlan& node) {
    std::vector<const NodePlan*> members;
    if (node.swapBarrier.empty() || !showsWall(config, plan, node)) return members;
    for (const NodePlan& other : plan.nodes)
        if (other.swapBarrier == node.swapBarrier && showsWall(config, plan, other)) members.push_back(&other);
    if (members.size() < 2) members.clear();
    return members;
}

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
    setup.pass = node.pass;
    setup.screen = node.screen;
    setup.collector = node.collector;
    setup.composition = nameOf(node.composition.value_or(compositor::Strategy::Serial));
    setup.answers = node.answers;
    setup.exchangeHere = std::none_of(plan.nodes.begin(), plan.nodes.end(), [&](const NodePlan& other) { return other.collector == node.collector && other.reach == NodeReach::LaunchCommand; });
    setup.eyeBase = config.eyeBase;
    setup.focusDistance = config.focusDistance;
    setup.tiling = config.tiling;
    setup.glBackend = config.glBackend;
    setup.sendPictures = config.display == Display::App || !config.out.empty() || headShowsWall(config, plan);
    setup.wallWindows = showsWall(config, plan, node);
    if (const auto members = swapMembersOf(config, plan, node); !members.empty()) {
        setup.swapMembers = static_cast<int>(members.size());
        setup.swapRank = static_cast<int>(std::ranges::find(members, node.node, &NodePlan::node) - members.begin());
        setup.swapLeader = members.front()->node;
        setup.swapHere = std::ranges::none_of(members, [](const NodePlan* m) { return m->reach == NodeReach::LaunchCommand; });
    }
    const NodeWindow window = node.window.value_or(NodeWindow{});
    setup.windowTitle = window.title;
    setup.windowAsOnWall = window.asOnWall;
    setup.fullScreen = config.fullScreen || window.fullScreen;
    setup.windowX = config.windowX + window.x;
    setup.windowY = config.windowY + window.y;
    setup.placeThreads = config.placeThreads;
    setup.displayName = window.displayName.empty() ? config.displayName : window.displayName;
    setup.build = streamBuild();
    return setup;
}

} // namespace mural
