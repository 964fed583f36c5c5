#include "nodes/head/planning/config/node_windows.hpp"

#include <cmath>

namespace mural {
namespace {

using config::at;
using config::Index;

bool coincide(const Viewport& a, const Viewport& b) {
    constexpr double kRounding = 1e-9;
    return std::abs(a.x - b.x) < kRounding && std::abs(a.y - b.y) < kRounding && std::abs(a.w - b.w) < kRounding &&
           std::abs(a.h - b.h) < kRounding;
}

Index channelOf(const WindowInput& input, const NodePlan& node) {
    return input.channels[static_cast<size_t>(node.node)];
}

// Returns the node that draws all of this part exactly as it is shown. Null: none.
NodePlan* showerOf(const WindowInput& input, const WallPart& part, SessionPlan& plan) {
    if (part.counts.kernelWidth * part.counts.kernelHeight * part.counts.samples != 1) return nullptr;
    NodePlan* drawer = nullptr;
    for (NodePlan& n : plan.nodes) {
        if (n.picture != part.firstPicture || n.pass.range != 0) continue;
        if (drawer) return nullptr;
        drawer = &n;
    }
    if (!drawer || drawer->pass.period > 1 || drawer->shown || !drawer->transferScale.none() ||
        !coincide(*drawer->area, part.area))
        return nullptr;
    const bool isDestination = input.source.config.channels[at(channelOf(input, *drawer))].isDestination();
    return isDestination ? drawer : nullptr;
}

// True if two nodes would show their pictures in one channel, or in windows of this machine that overlap.
bool wouldCollide(const WindowInput& input, const std::vector<NodePlan*>& shows) {
    for (size_t a = 0; a < shows.size(); ++a)
        for (size_t b = 0; b < a; ++b) {
            if (channelOf(input, *shows[a]) == channelOf(input, *shows[b])) return true;
            if (input.allLocal && !intersect(*shows[a]->area, *shows[b]->area).empty()) return true;
        }
    return false;
}

// If all nodes run on this machine, windows are arranged like the wall.
NodeWindow windowOf(const WindowInput& input, Index index) {
    const config::ResolvedConfig& config = input.source.config;
    const config::ResolvedChannel& channel = config.channels[at(index)];
    const config::ResolvedWindow& window = config.windows[at(channel.window)];
    const config::ResolvedPipe& pipe = config.pipes[at(window.pipe)];
    NodeWindow shown;
    shown.title = "Mural " + input.source.channelName(index);
    if (input.allLocal) return shown;
    const compound::DisplaySizes& sizes = input.sizes;
    shown.asOnWall = false;
    shown.x = sizes.windows[at(channel.window)].x + sizes.channels[at(index)].x;
    shown.y = sizes.windows[at(channel.window)].y + sizes.channels[at(index)].y;
    shown.fullScreen = window.attributes.hintFullscreen == config::value::kOn;
    if (pipe.device || pipe.port)
        shown.displayName = ":" + std::to_string(pipe.port.value_or(0)) + "." + std::to_string(pipe.device.value_or(0));
    return shown;
}

} // namespace

void placeWindows(const WindowInput& input, SessionPlan& plan) {
    plan.nodesShowWall = false;
    std::vector<NodePlan*> shows;
    for (const WallPart& part : plan.wall.parts) {
        NodePlan* shower = showerOf(input, part, plan);
        if (!shower) return;
        shows.push_back(shower);
    }
    if (wouldCollide(input, shows)) return;
    plan.nodesShowWall = true;
    for (NodePlan* n : shows) {
        const Index channel = channelOf(input, *n);
        n->window = windowOf(input, channel);
        const Index window = input.source.config.channels[at(channel)].window;
        if (const auto barrier = input.barriers.find(window); barrier != input.barriers.end())
            n->swapBarrier = barrier->second;
    }
}

} // namespace mural
