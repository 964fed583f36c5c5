#include "nodes/head/node_plan.hpp"

#include <algorithm>

#include "nodes/head/tile_split.hpp"
#include "nodes/session/stream_build.hpp"

namespace mural {
namespace {

constexpr int kMostLocalByDefault = 4;

NodeReach reachOf(const std::string& host, const std::string& ownHost) {
    const bool here = host == "localhost" || host == "127.0.0.1" || host == ownHost;
    return here ? NodeReach::Tcp : NodeReach::LaunchCommand;
}

std::string countOf(int count, const char* one) {
    return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string describeRegion(const NodePlan& plan) {
    const TileRegion& r = plan.region;
    return "node " + std::to_string(plan.node) + " (" + plan.where + ") draws " +
           countOf(r.columns * r.rows, "tile") + ": columns " + std::to_string(r.column) + " to " +
           std::to_string(r.column + r.columns - 1) + ", rows " + std::to_string(r.row) + " to " +
           std::to_string(r.row + r.rows - 1) + " (row 0 is the lowest)";
}

} // namespace

SessionPlan planSession(const SessionConfig& config, const std::string& ownHost) {
    const int tiles = config.columns * config.rows;
    int localNodes = config.localNodes;
    if (localNodes == 0 && config.hosts.empty()) localNodes = std::min(tiles, kMostLocalByDefault);
    const int wanted = localNodes + static_cast<int>(config.hosts.size());
    const int count = std::min(wanted, tiles);

    SessionPlan plan;
    const std::vector<TileRegion> regions = splitGrid(config.columns, config.rows, count);
    for (int i = 0; i < count; ++i) {
        NodePlan node;
        node.node = i;
        node.where = "local";
        node.region = regions[static_cast<size_t>(i)];
        if (i >= localNodes) {
            node.where = config.hosts[static_cast<size_t>(i - localNodes)];
            node.reach = reachOf(node.where, ownHost);
        }
        plan.explain.push_back(describeRegion(node));
        plan.nodes.push_back(node);
    }
    if (wanted > tiles) {
        plan.warnings.push_back(countOf(wanted, "render node") + " asked for, but there " +
                                (tiles == 1 ? "is " : "are ") + countOf(tiles, "tile") + ": only " +
                                countOf(count, "node") + " started; --tiles makes more tiles");
    }
    return plan;
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
    setup.tiling = config.tiling;
    setup.glBackend = config.glBackend;
    setup.sendPictures = config.display == Display::App || !config.out.empty();
    setup.wallWindows = config.display == Display::Windows;
    setup.fullScreen = config.fullScreen;
    setup.windowX = config.windowX;
    setup.windowY = config.windowY;
    setup.placeThreads = config.placeThreads;
    setup.displayName = config.displayName;
    setup.build = streamBuild();
    return setup;
}

} // namespace mural
