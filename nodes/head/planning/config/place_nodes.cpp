#include "nodes/head/planning/config/place_nodes.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "nodes/frame_transfer/plane_codecs.hpp"
#include "nodes/head/planning/compound_pass.hpp"

namespace mural {
namespace {

using compound::RenderContext;
using config::at;
using config::Index;
using config::kNone;

Index rootOf(const config::ResolvedConfig& config, Index compound) {
    while (config.compounds[at(compound)].parent != kNone) compound = config.compounds[at(compound)].parent;
    return compound;
}

// Without a value in the file, the number of nodes determines the strategy later.
Result<void> takeComposition(const ConfigSource& source, Index compound, NodePlan& node) {
    const config::ResolvedCompound& from = source.config.compounds[at(compound)];
    if (from.composition.empty() || from.composition == "auto") return {};
    node.composition = compositor::strategyNamed(from.composition);
    if (node.composition) return {};
    std::string names = "auto";
    for (const compositor::Strategy s : compositor::kEveryStrategy) names += std::string(", ") + nameOf(s);
    return Error{source.lineOf(from.at) + ": mural_composition \"" + from.composition + "\": must be one of " + names};
}

// Takes the codec of the pictures that a compound outputs. A compound that inputs a picture may override it.
Result<void> takeCodec(const ConfigSource& source, Index compound, NodePlan& node) {
    const auto& compounds = source.config.compounds;
    for (const config::ResolvedFrame& given : compounds[at(compound)].outputFrames) {
        const config::ResolvedFrame* named = &given;
        bool exact = given.exact;
        for (size_t taker = 0; taker < compounds.size(); ++taker)
            for (const config::ResolvedFrame& taken : compounds[taker].inputFrames) {
                if (taken.name != given.name ||
                    rootOf(source.config, static_cast<Index>(taker)) != rootOf(source.config, compound))
                    continue;
                exact = exact && taken.exact;
                if (taken.codec != kQuickestCodec) named = &taken;
            }
        const std::string location = source.lineOf(named->at) + ": mural_codec \"" + named->codec + "\"";
        auto wanted = wantedCodec(named->codec);
        if (!wanted) return Error{location + ": " + wanted.error().message};
        if (!wanted->lossless && exact)
            return Error{location + " is lossy; set mural_exact OFF in the same frame, or choose another codec"};
        node.codec = named->codec == kQuickestCodec && !exact ? kLossyCodec : named->codec;
    }
    return {};
}

class NodePlacer {
public:
    NodePlacer(const ConfigSource& source, const PlanOptions& options, SessionPlan& plan)
        : source_(source), config_(source.config), options_(options), plan_(plan) {}

    // Adds the nodes of one group: draws of one area of one picture, in the order of their ranges.
    Result<void> addGroup(const std::vector<const ConfigDraw*>& draws) {
        const auto collector = static_cast<int>(plan_.nodes.size());
        const Zoom zoom = passOf(config_, draws.front()->context).zoom;
        for (const ConfigDraw* draw : draws) {
            const Index compound = draw->context.compound;
            NodePlan node = makeNode(*draw);
            warnTooLarge(compound);
            if (node.pass.zoom != zoom)
                return Error{source_.lineOf(config_.compounds[at(compound)].at) +
                             ": ranges of one picture have different zooms and cannot be composited by depth; give "
                             "all of them the same zoom"};
            node.pass.range = node.node - collector;
            node.pass.ranges = static_cast<int>(draws.size());
            node.collector = collector;
            if (auto named = takeComposition(source_, compound, node); !named) return named;
            if (auto named = takeCodec(source_, compound, node); !named) return named;
            node.answers = node.answers && node.pass.range == 0;
            plan_.nodes.push_back(std::move(node));
            channels_.push_back(draw->context.channel);
        }
        return {};
    }

    std::vector<Index> takeChannels() { return std::move(channels_); }

private:
    // Returns the node of a draw, without its place in a group.
    [[nodiscard]] NodePlan makeNode(const ConfigDraw& draw) const {
        const RenderContext& c = draw.context;
        NodePlan node;
        node.node = static_cast<int>(plan_.nodes.size());
        node.pass = passOf(config_, c);
        node.picture = draw.picture;
        node.area = draw.area;
        node.shown = draw.shown;
        node.transferScale = draw.transferScale;
        node.task = DrawTask{c.compound, c.destination, c.view, c.eye};
        node.isPlacedByFrames = draw.flow.steered;
        node.screen = draw.screen;
        node.answers = c.eye != Eye::Right && c.pixel.x == 0 && c.pixel.y == 0 && c.subPixel.index == 0;
        placeOnHost(node, c);
        return node;
    }

    void placeOnHost(NodePlan& node, const RenderContext& c) const {
        const config::ResolvedPipe& pipe = config_.pipeOf(config_.channels[at(c.channel)]);
        const config::ResolvedNode& machine = config_.nodes[at(pipe.node)];
        node.where = "local";
        if (options_.allLocal || machine.isApplication || machine.host.empty()) return;
        node.where = machine.host;
        node.reach = reachOf(machine.host, options_.ownHost);
    }

    void warnTooLarge(Index compound) {
        const Zoom zoom = zoomOf(config_, compound);
        if ((zoom.x <= kMaxZoom && zoom.y <= kMaxZoom) || !tooLarge_.insert(compound).second) return;
        plan_.warnings.push_back(source_.placeOf(compound) + ": nodes draw at most " +
                                 std::to_string(static_cast<int>(kMaxZoom)) + " times the shown size; reduce the zoom");
    }

    const ConfigSource& source_;
    const config::ResolvedConfig& config_;
    const PlanOptions& options_;
    SessionPlan& plan_;
    std::vector<Index> channels_; // per node
    std::set<Index> tooLarge_;    // compounds already reported as too large
};

} // namespace

Result<std::vector<Index>> placeNodes(const ConfigSource& source, const PlanOptions& options,
                                      const std::vector<ConfigDraw>& draws, SessionPlan& plan) {
    // A group contains draws of one area of one picture that differ only in their range.
    using Group = std::tuple<int, uint32_t, double, double, double, double>;
    std::map<Group, std::vector<const ConfigDraw*>> groups;
    for (const ConfigDraw& d : draws) {
        const Viewport& a = d.onWall();
        groups[{d.picture, d.context.phase, a.x, a.y, a.w, a.h}].push_back(&d);
    }
    NodePlacer placer(source, options, plan);
    for (auto& [key, group] : groups) {
        std::sort(group.begin(), group.end(), [](const ConfigDraw* a, const ConfigDraw* b) {
            return a->context.range.start < b->context.range.start;
        });
        if (auto added = placer.addGroup(group); !added) return added.error();
    }
    return placer.takeChannels();
}

} // namespace mural
