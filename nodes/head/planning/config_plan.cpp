#include "nodes/head/planning/config_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "balancer/compound/partition.hpp"
#include "balancer/compound/even_split.hpp"
#include "balancer/compound/frame_flow.hpp"
#include "balancer/compound/frusta.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "nodes/head/planning/compound_pass.hpp"
#include "nodes/head/planning/unsupported_fields.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"

namespace mural {

namespace {

using compound::FrameInput;
using compound::FramePlan;
using compound::LoadedConfig;
using compound::RenderContext;
using config::at;
using config::Index;
using config::kNone;
using config::ResolvedConfig;

constexpr uint32_t kMaxTurns = 64; // bounds periods without a small common multiple

// One draw task of the compound tree.
struct Draw {
    RenderContext context;
    Viewport area;                 // on the canvas
    compound::Flow flow;           // the path of its frames
    std::optional<Viewport> shown; // on the canvas, if different from area
    Zoom transferScale;            // scale of its picture in transfer
    [[nodiscard]] const Viewport& onWall() const { return shown ? *shown : area; }
};

std::string nameOf(const config::ResolvedChannel& channel, Index index) {
    return channel.name.empty() ? "channel " + std::to_string(index) : channel.name;
}

class Planner {
public:
    // only: plans this canvas alone; nodesBefore nodes of other canvases precede its nodes.
    Planner(const LoadedConfig& loaded, const PlanOptions& options, Index only = kNone, int nodesBefore = 0)
        : config_(loaded.resolved),
          file_(loaded.diagnostics.file()),
          options_(options),
          only_(only),
          nodesBefore_(nodesBefore) {}

    Result<SessionPlan> plan() {
        if (auto chosen = chooseLayouts(); !chosen) return chosen.error();
        gather();
        if (auto chosen = chooseCanvas(); !chosen) return chosen.error();
        followFrames();
        if (draws_.empty())
            return Error{file_ + ": no channel draws: it has no canvas with segments, or no compound with channels; "
                                 "see mural config print --resolved"};
        if (auto done = placeParts(); !done) return done.error();
        chooseProjection();
        if (auto placed = placeNodes(); !placed) return placed.error();
        placeWindows();
        takeObserver();
        addExplanations();
        input_.frameNumber = 0;
        plan_.balance =
            std::make_shared<BalancePlan>(BalancePlan{config_, input_, sizeOf(canvas_), options_.balance, {}});
        return std::move(plan_);
    }

    compound::PixelSize wallSize() {
        if (!chooseLayouts()) return {0, 0};
        for (size_t c = 0; c < config_.canvases.size(); ++c) {
            if (!options_.canvas.empty() && config_.canvases[c].name != options_.canvas) continue;
            if (const compound::PixelSize size = sizeOf(static_cast<Index>(c)); size.w > 0) return size;
        }
        return {0, 0};
    }

    // The size of a canvas, derived from its first segment with a channel.
    [[nodiscard]] compound::PixelSize sizeOf(Index canvas) const {
        if (canvas == kNone) return {0, 0};
        const compound::DisplaySizes sizes = compound::displaySizes(config_);
        for (const Index s : config_.canvases[at(canvas)].segments) {
            const config::ResolvedSegment& segment = config_.segments[at(s)];
            if (segment.channel == kNone || segment.viewport.empty()) continue;
            const PixelViewport& pixels = sizes.channels[at(segment.channel)];
            return {static_cast<int32_t>(std::lround(pixels.w / segment.viewport.w)),
                    static_cast<int32_t>(std::lround(pixels.h / segment.viewport.h))};
        }
        return {0, 0};
    }

    // The canvases that show something, the planned one included. Valid after plan().
    [[nodiscard]] const std::set<Index>& canvases() const { return canvases_; }
    [[nodiscard]] Index canvas() const { return canvas_; }

private:
    Result<void> chooseLayouts() {
        input_ = compound::firstFrame(config_);
        input_.activeLayouts.resize(config_.canvases.size(), 0);
        input_.views.resize(config_.views.size());
        for (compound::ViewState& view : input_.views) view.modelUnit = options_.modelUnit;
        for (const std::string& wanted : options_.layouts) {
            bool found = false;
            for (size_t c = 0; c < config_.canvases.size(); ++c) {
                const auto& layouts = config_.canvases[c].layouts;
                for (size_t i = 0; i < layouts.size(); ++i) {
                    if (layouts[i] == kNone || config_.layouts[at(layouts[i])].name != wanted) continue;
                    input_.activeLayouts[c] = static_cast<Index>(i);
                    found = true;
                }
            }
            if (!found)
                return Error{"--layout \"" + wanted + "\": no canvas of " + file_ +
                             " has this layout; mural config print shows the layouts"};
        }
        return {};
    }

    // Collects the draws of all phases, each once.
    void gather() {
        uint32_t period = 1;
        for (const config::ResolvedCompound& c : config_.compounds) {
            const uint32_t own = std::max<uint32_t>(1, c.period.value_or(1));
            period = std::min(kMaxTurns, std::lcm(period, std::min(own, kMaxTurns)));
        }
        std::set<std::tuple<Index, Index, Index, Eye>> seen;
        for (uint32_t frame = 0; frame < period; ++frame) {
            input_.frameNumber = frame;
            const FramePlan plan = compound::planFrame(config_, input_);
            const std::vector<compound::Flow> flows = compound::flowOf(config_, input_, plan);
            for (const compound::PlannedBarrier& barrier : plan.barriers)
                for (const Index window : barrier.windows) barriers_.try_emplace(window, barrier.name);
            std::map<Index, std::vector<size_t>> workers; // draws by queue
            for (const compound::ChannelPlan& channel : plan.channels) {
                for (const compound::PlannedTask& task : channel.tasks) {
                    if (task.kind != config::Task::Draw || task.context == kNone) continue;
                    const RenderContext& c = plan.contexts[at(task.context)];
                    if (c.view == kNone || !seen.emplace(c.compound, c.destination, c.view, c.eye).second) continue;
                    draws_.push_back(
                        {c, compose(config_.views[at(c.view)].viewport, c.part), flows[at(task.context)], {}, {}});
                    if (task.queue != kNone) workers[task.queue].push_back(draws_.size() - 1);
                }
            }
            for (const auto& [queue, draws] : workers) dealOut(plan, plan.queues[at(queue)], draws);
        }
    }

    [[nodiscard]] Index canvasOf(const Draw& d) const {
        const Index segment = config_.channels[at(d.context.destination)].segment;
        return segment == kNone ? kNone : config_.segments[at(segment)].canvas;
    }

    // Each canvas is a separate wall.
    Result<void> chooseCanvas() {
        std::set<Index>& canvases = canvases_;
        for (const Draw& d : draws_) canvases.insert(canvasOf(d));
        if (only_ != kNone) canvases = {only_};
        Index chosen = canvases.empty() ? kNone : *canvases.begin();
        if (!options_.canvas.empty()) {
            const auto named = std::find_if(canvases.begin(), canvases.end(), [&](Index c) {
                return c != kNone && config_.canvases[at(c)].name == options_.canvas;
            });
            if (named == canvases.end())
                return Error{"--canvas \"" + options_.canvas + "\": " + file_ +
                             " has no channel on a canvas of this name; mural config print shows the canvases"};
            chosen = *named;
            canvases = {chosen};
        }
        std::erase_if(draws_, [&](const Draw& d) { return canvasOf(d) != chosen; });
        canvas_ = chosen;
        return {};
    }

    // If frames crop, move or scale pictures, the draws whose pictures reach a part of the wall determine that part.
    void followFrames() {
        using Destination = std::tuple<Index, Eye>;
        using One = std::tuple<Index, Eye, int, int, int, int, int, int, uint32_t>; // picture of a destination
        std::set<Destination> steered;
        for (const Draw& d : draws_)
            if (d.flow.steered) steered.insert({d.context.destination, d.context.eye});
        if (steered.empty()) return;
        std::vector<Draw> followed;
        std::map<One, std::vector<const Draw*>> pictures;
        for (const Draw& d : draws_) {
            const RenderContext& c = d.context;
            if (!steered.contains({c.destination, c.eye}))
                followed.push_back(d);
            else
                pictures[{c.destination, c.eye, c.pixel.x, c.pixel.y, c.pixel.w, c.pixel.h, c.subPixel.index,
                          c.subPixel.size, c.phase}]
                    .push_back(&d);
        }
        for (const auto& [key, draws] : pictures) takeApart(draws, followed);
        draws_ = std::move(followed);
    }

    // A draw whose picture reaches one part of the wall, or several parts with the same scale and offset.
    struct Arrival {
        const Draw* draw;
        Zoom scale;  // from the drawn picture to the part of the wall
        double x, y; // position of the drawn picture's corner, in units of the picture's size
        Zoom transferScale;
        [[nodiscard]] bool moved() const {
            return std::abs(scale.x - 1) > 1e-6 || std::abs(scale.y - 1) > 1e-6 || std::abs(x) > 1e-6 ||
                   std::abs(y) > 1e-6;
        }
    };
    static bool alike(const Arrival& a, const Arrival& b) {
        const auto isClose = [](double v, double w) { return std::abs(v - w) < 1e-6; };
        return isClose(a.scale.x, b.scale.x) && isClose(a.scale.y, b.scale.y) && isClose(a.x, b.x) &&
               isClose(a.y, b.y) && isClose(a.transferScale.x, b.transferScale.x) &&
               isClose(a.transferScale.y, b.transferScale.y);
    }

    void takeApart(std::vector<const Draw*> draws, std::vector<Draw>& into) {
        // the destination's own picture comes first
        std::stable_partition(draws.begin(), draws.end(),
                              [](const Draw* d) { return d->context.channel == d->context.destination; });
        std::vector<Arrival> arrivals;
        std::vector<compound::Rect> pieces;
        for (const Draw* d : draws) {
            if (d->flow.parts.empty())
                plan_.explain.push_back(placeOf(d->context.compound) +
                                        ": the pixels drawn here are not transferred to the wall");
            for (const compound::ShownPart& p : d->flow.parts) {
                const Zoom scale{p.to.w / p.from.w, p.to.h / p.from.h};
                const Arrival a{d, scale, p.to.x - p.from.x * scale.x, p.to.y - p.from.y * scale.y, p.transferScale};
                auto known = std::find_if(arrivals.begin(), arrivals.end(),
                                          [&](const Arrival& other) { return other.draw == d && alike(other, a); });
                if (known == arrivals.end()) known = arrivals.insert(arrivals.end(), a);
                pieces.push_back({static_cast<int>(known - arrivals.begin()), compose(d->area, p.to)});
            }
        }
        std::vector<compound::Rect> needed;
        for (const compound::Cell& cell : compound::cellsOf(pieces)) {
            std::vector<Range> drawn;
            // of two draws with the same range the first one counts, because a depth test keeps existing pixels
            for (const int i : cell.of) {
                const Range& range = arrivals[static_cast<size_t>(i)].draw->context.range;
                if (std::find(drawn.begin(), drawn.end(), range) != drawn.end()) continue;
                drawn.push_back(range);
                needed.push_back({i, cell.area});
            }
        }
        for (const compound::Cell& cell : compound::cellsOf(needed)) {
            std::vector<const Arrival*> there;
            for (const int i : cell.of) there.push_back(&arrivals[static_cast<size_t>(i)]);
            const bool together =
                std::all_of(there.begin(), there.end(),
                            [&](const Arrival* a) {
                                return alike(*a, *there.front()) && a->draw->area == there.front()->draw->area;
                            }) ||
                std::none_of(there.begin(), there.end(),
                             [&](const Arrival* a) { return a->moved() || !a->transferScale.none(); });
            if (!together && unlike_.insert(there.front()->draw->context.destination).second)
                plan_.warnings.push_back(placeOf(there.front()->draw->context.compound) +
                                         ": ranges of one picture are composited by depth at their drawn size; the "
                                         "zoom of their frames must be equal and is ignored");
            for (const Arrival* a : there) {
                Draw d = *a->draw;
                d.area = cell.area;
                if (together) d.transferScale = a->transferScale;
                if (together && a->moved()) {
                    const Viewport own = relativeTo(cell.area, a->draw->area);
                    d.area = compose(a->draw->area, Viewport{(own.x - a->x) / a->scale.x, (own.y - a->y) / a->scale.y,
                                                             own.w / a->scale.x, own.h / a->scale.y});
                    d.shown = cell.area;
                }
                into.push_back(d);
            }
        }
    }

    // Divides the picture or the range into equal strips, one per worker of the queue, in the order of the tree. The
    // queue's equalizer divides in this order, too: the ranks of ranges never change.
    void dealOut(const FramePlan& plan, const compound::PlannedQueue& queue, std::vector<size_t> draws) {
        std::ranges::sort(draws, {}, [&](size_t d) { return draws_[d].context.compound; });
        const RenderContext& divided = plan.contexts[at(queue.context)];
        const bool chunks = !queue.tiles.empty() &&
                            std::any_of(queue.tiles.begin(), queue.tiles.end(),
                                        [&](const compound::PlannedTile& t) { return t.range != divided.range; });
        const double n = static_cast<double>(draws.size());
        for (size_t i = 0; i < draws.size(); ++i) {
            Draw& d = draws_[draws[i]];
            const double from = static_cast<double>(i) / n, to = static_cast<double>(i + 1) / n;
            const Viewport whole = compose(config_.views[at(divided.view)].viewport, divided.part);
            d.area = chunks ? whole : compose(whole, Viewport{0, from, 1, to - from});
            d.context.range = chunks ? compose(divided.range, Range{from, to}) : divided.range;
        }
        if (queue.tiles.empty()) return;
        if (draws_[draws.front()].flow.ignored)
            plan_.warnings.push_back(placeOf(draws_[draws.front()].context.compound) + ": pixels of queue \"" +
                                     queue.name +
                                     "\" are shown at their drawn position and size; viewport and zoom of its frames "
                                     "are ignored; remove them, or divide the picture without a queue");
    }

    // Determines the destinations, their eyes, and the pictures that each is composed of.
    Result<void> placeParts() {
        using Key = std::tuple<Index, Eye>;
        std::map<Key, std::vector<size_t>> parts;
        for (size_t i = 0; i < draws_.size(); ++i)
            parts[{draws_[i].context.destination, draws_[i].context.eye}].push_back(i);
        int next = 0;
        for (const auto& [key, draws] : parts) {
            const RenderContext& first = draws_[draws.front()].context;
            const config::ResolvedChannel& channel = config_.channels[at(first.destination)];
            WallPart part;
            part.name = nameOf(channel, first.destination);
            part.eye = first.eye;
            using config::ColorComponent;
            part.colours = {first.eyeColors.has(ColorComponent::Red), first.eyeColors.has(ColorComponent::Green),
                            first.eyeColors.has(ColorComponent::Blue)};
            part.area = destinationArea(draws);
            part.counts.kernelWidth = first.pixel.w;
            part.counts.kernelHeight = first.pixel.h;
            part.counts.samples = first.subPixel.size;
            part.firstPicture = next;
            std::set<int> made;
            for (const size_t i : draws) {
                const RenderContext& c = draws_[i].context;
                const PassCounts& n = part.counts;
                if (c.pixel.w != n.kernelWidth || c.pixel.h != n.kernelHeight || c.subPixel.size != n.samples)
                    return Error{
                        file_ + ":" + std::to_string(config_.compounds[at(c.compound)].at.line) + ": channel \"" +
                        part.name +
                        "\" combines parts with different pixel or subpixel kernels; give all of them the same kernel"};
                const int picture = next + pictureOf(n, passOf(config_, c));
                pictures_.resize(draws_.size(), 0);
                pictures_[i] = picture;
                made.insert(picture);
            }
            if (static_cast<int>(made.size()) < picturesOf(part.counts))
                plan_.warnings.push_back(file_ + ": channel \"" + part.name +
                                         "\": no compound draws some pixels or samples of its kernel; they stay black");
            next += picturesOf(part.counts);
            if (first.stereoMode == compound::StereoMode::Anaglyph) anaglyph_ = true;
            if (first.stereoMode == compound::StereoMode::Quad && first.eye == Eye::Left) quad_ = true;
            plan_.wall.parts.push_back(part);
        }
        plan_.wall.stereo = anaglyph_ ? StereoMode::Anaglyph : quad_ ? StereoMode::Quad : StereoMode::SideBySide;
        return {};
    }

    // The bounding box of all draws of the destination.
    [[nodiscard]] Viewport destinationArea(const std::vector<size_t>& draws) const {
        double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
        for (const size_t i : draws) {
            const Viewport& a = draws_[i].onWall();
            x0 = std::min(x0, a.x);
            y0 = std::min(y0, a.y);
            x1 = std::max(x1, a.x + a.w);
            y1 = std::max(y1, a.y + a.h);
        }
        return {x0, y0, x1 - x0, y1 - y0};
    }

    // Orders nodes by group. A group contains draws of one area of one picture that differ only in their range.
    Result<void> placeNodes() {
        using Key = std::tuple<int, uint32_t, double, double, double, double>;
        std::map<Key, std::vector<size_t>> groups;
        for (size_t i = 0; i < draws_.size(); ++i) {
            const Viewport& a = draws_[i].onWall();
            groups[{pictures_[i], draws_[i].context.phase, a.x, a.y, a.w, a.h}].push_back(i);
        }
        for (auto& [key, draws] : groups) {
            std::sort(draws.begin(), draws.end(), [&](size_t a, size_t b) {
                return draws_[a].context.range.start < draws_[b].context.range.start;
            });
            const auto collector = static_cast<int>(plan_.nodes.size());
            int rank = 0;
            for (const size_t i : draws) {
                const RenderContext& c = draws_[i].context;
                NodePlan node;
                node.node = static_cast<int>(plan_.nodes.size());
                node.pass = passOf(config_, c);
                warnTooLarge(c.compound);
                if (node.pass.zoom != passOf(config_, draws_[draws.front()].context).zoom)
                    return Error{file_ + ":" + std::to_string(config_.compounds[at(c.compound)].at.line) +
                                 ": ranges of one picture have different zooms and cannot be composited by depth; give "
                                 "all of them the same zoom"};
                node.pass.range = rank++;
                node.pass.ranges = static_cast<int>(draws.size());
                node.picture = pictures_[i];
                node.area = draws_[i].area;
                node.shown = draws_[i].shown;
                node.transferScale = draws_[i].transferScale;
                node.task = DrawTask{c.compound, c.destination, c.view, c.eye};
                node.isPlacedByFrames = draws_[i].flow.steered;
                node.screen = screenOf(c);
                node.collector = collector;
                if (auto named = takeComposition(node, config_.compounds[at(c.compound)]); !named) return named;
                if (auto named = takeCodec(node, c.compound); !named) return named;
                node.answers = node.pass.range == 0 && c.eye != Eye::Right && c.pixel.x == 0 && c.pixel.y == 0 &&
                               c.subPixel.index == 0;
                placeOnHost(node, c);
                plan_.nodes.push_back(node);
                channels_.push_back(c.channel);
            }
        }
        return {};
    }

    // The position of a compound in the file, for messages.
    [[nodiscard]] std::string placeOf(Index compound) const {
        const config::SourcePosition& there = config_.compounds[at(compound)].at;
        return file_ + ":" + std::to_string(there.line) + ":" + std::to_string(there.column);
    }

    void warnTooLarge(Index compound) {
        const Zoom zoom = zoomOf(config_, compound);
        if ((zoom.x <= kMaxZoom && zoom.y <= kMaxZoom) || !tooLarge_.insert(compound).second) return;
        plan_.warnings.push_back(placeOf(compound) + ": nodes draw at most " +
                                 std::to_string(static_cast<int>(kMaxZoom)) + " times the shown size; reduce the zoom");
    }

    // Without a value in the file, the number of nodes determines the strategy later.
    [[nodiscard]] Result<void> takeComposition(NodePlan& node, const config::ResolvedCompound& compound) const {
        if (compound.composition.empty() || compound.composition == "auto") return {};
        node.composition = compositor::strategyNamed(compound.composition);
        if (node.composition) return {};
        std::string names = "auto";
        for (const compositor::Strategy s : compositor::kEveryStrategy) names += std::string(", ") + nameOf(s);
        return Error{file_ + ":" + std::to_string(compound.at.line) + ": mural_composition \"" + compound.composition +
                     "\": must be one of " + names};
    }

    [[nodiscard]] Index rootOf(Index compound) const {
        while (config_.compounds[at(compound)].parent != kNone) compound = config_.compounds[at(compound)].parent;
        return compound;
    }

    // The codec of the pictures that a compound outputs. A compound that inputs a picture may override it.
    [[nodiscard]] Result<void> takeCodec(NodePlan& node, Index compound) const {
        for (const config::ResolvedFrame& given : config_.compounds[at(compound)].outputFrames) {
            const config::ResolvedFrame* named = &given;
            bool exact = given.exact;
            for (size_t taker = 0; taker < config_.compounds.size(); ++taker)
                for (const config::ResolvedFrame& taken : config_.compounds[taker].inputFrames) {
                    if (taken.name != given.name || rootOf(static_cast<Index>(taker)) != rootOf(compound)) continue;
                    exact = exact && taken.exact;
                    if (taken.codec != kQuickestCodec) named = &taken;
                }
            const std::string location =
                file_ + ":" + std::to_string(named->at.line) + ": mural_codec \"" + named->codec + "\"";
            auto wanted = wantedCodec(named->codec);
            if (!wanted) return Error{location + ": " + wanted.error().message};
            if (!wanted->lossless && exact)
                return Error{location + " is lossy; set mural_exact OFF in the same frame, or choose another codec"};
            node.codec = named->codec == kQuickestCodec && !exact ? kLossyCodec : named->codec;
        }
        return {};
    }

    void placeOnHost(NodePlan& node, const RenderContext& c) const {
        const config::ResolvedPipe& pipe = config_.pipeOf(config_.channels[at(c.channel)]);
        const config::ResolvedNode& machine = config_.nodes[at(pipe.node)];
        node.where = "local";
        if (options_.allLocal || machine.isApplication || machine.host.empty()) return;
        node.where = machine.host;
        node.reach = reachOf(machine.host, options_.ownHost);
    }

    // Nodes show their own pictures if the file assigns a window to their channel, and one node draws each channel of
    // the wall exactly as it is shown. Otherwise the head shows the wall.
    void placeWindows() {
        std::vector<NodePlan*> shows;
        for (const WallPart& part : plan_.wall.parts) {
            const bool plain = part.counts.kernelWidth * part.counts.kernelHeight * part.counts.samples == 1;
            NodePlan* drawer = nullptr;
            int pictures = 0;
            for (NodePlan& n : plan_.nodes) {
                if (n.picture != part.firstPicture || n.pass.range != 0) continue;
                ++pictures;
                drawer = &n;
            }
            if (!plain || pictures != 1 || drawer->pass.period > 1 || drawer->shown || !drawer->transferScale.none() ||
                !same(*drawer->area, part.area) || !isDestination(*drawer))
                return headShowsIt();
            shows.push_back(drawer);
        }
        for (size_t a = 0; a < shows.size(); ++a)
            for (size_t b = 0; b < a; ++b) {
                const bool sameChannel = channels_[node(*shows[a])] == channels_[node(*shows[b])];
                if (sameChannel || (options_.allLocal && !intersect(*shows[a]->area, *shows[b]->area).empty()))
                    return headShowsIt();
            }
        for (NodePlan* n : shows) {
            const Index channel = channels_[node(*n)];
            n->window = windowOf(channel);
            if (const auto barrier = barriers_.find(config_.channels[at(channel)].window); barrier != barriers_.end())
                n->swapBarrier = barrier->second;
        }
    }

    static bool same(const Viewport& a, const Viewport& b) {
        constexpr double kRounding = 1e-9;
        return std::abs(a.x - b.x) < kRounding && std::abs(a.y - b.y) < kRounding && std::abs(a.w - b.w) < kRounding &&
               std::abs(a.h - b.h) < kRounding;
    }
    void headShowsIt() { plan_.nodesShowWall = false; }
    static size_t node(const NodePlan& n) { return static_cast<size_t>(n.node); }

    [[nodiscard]] bool isDestination(const NodePlan& n) const {
        return config_.channels[at(channels_[node(n)])].isDestination();
    }

    // If all nodes run on this machine, windows are arranged like the wall.
    [[nodiscard]] NodeWindow windowOf(Index index) const {
        const config::ResolvedChannel& channel = config_.channels[at(index)];
        const config::ResolvedWindow& window = config_.windows[at(channel.window)];
        const config::ResolvedPipe& pipe = config_.pipes[at(window.pipe)];
        NodeWindow shown;
        shown.title = "Mural " + nameOf(channel, index);
        if (options_.allLocal) return shown;
        const compound::DisplaySizes& sizes = input_.sizes;
        shown.asOnWall = false;
        shown.x = sizes.windows[at(channel.window)].x + sizes.channels[at(index)].x;
        shown.y = sizes.windows[at(channel.window)].y + sizes.channels[at(index)].y;
        shown.fullScreen = window.attributes.hintFullscreen == config::value::kOn;
        if (pipe.device || pipe.port)
            shown.displayName =
                ":" + std::to_string(pipe.port.value_or(0)) + "." + std::to_string(pipe.device.value_or(0));
        return shown;
    }

    // The observer of the first stereo view.
    void takeObserver() {
        for (const Draw& d : draws_) {
            const Index o = config_.views[at(d.context.view)].observer;
            if (d.context.eye == Eye::Cyclop || o == kNone) continue;
            const config::ResolvedObserver& observer = config_.observers[at(o)];
            plan_.eyeBase = length(observer.eyeRight - observer.eyeLeft);
            plan_.focusDistance = observer.focusDistance;
            return;
        }
    }

    // True if some screen has another orientation than the first.
    [[nodiscard]] bool standAtAngles() const {
        const auto normal = [](const RenderContext& c) {
            return transformDirection(rigidInverse(c.perspectiveHead), {0, 0, 1});
        };
        return std::any_of(draws_.begin(), draws_.end(), [&](const Draw& d) {
            return dot(normal(d.context), normal(draws_.front().context)) < 1 - 1e-6;
        });
    }

    void chooseProjection() {
        const bool atAngles = standAtAngles();
        inRoom_ = options_.projection == ProjectionChoice::Room ||
                  (options_.projection == ProjectionChoice::Auto && atAngles);
        if (inRoom_)
            plan_.explain.push_back(
                std::string(atAngles ? "its screens stand at angles to each other: " : "") +
                "each screen shows the scene from the observer's eyes (--projection program: one flat picture)");
        else if (atAngles)
            plan_.explain.push_back("its screens stand at angles to each other, but show the program's picture as one "
                                    "flat wall (--projection program)");
        if (!inRoom_) return;
        std::set<Index> behind;
        for (const Draw& d : draws_)
            if (d.context.behindScreen && behind.insert(d.context.destination).second)
                plan_.warnings.push_back(file_ + ": the observer's eyes are behind the screen of channel \"" +
                                         nameOf(config_.channels[at(d.context.destination)], d.context.destination) +
                                         "\"; it shows its part of the program's own picture");
    }

    [[nodiscard]] std::optional<ScreenView> screenOf(const RenderContext& c) const {
        if (!inRoom_ || c.behindScreen) return {};
        const Frustum& f = c.destinationPerspective;
        const double n = f.nearPlane;
        const Viewport area = compose(config_.views[at(c.view)].viewport,
                                      compound::coverage(config_, config_.channels[at(c.destination)]));
        return ScreenView{area, f.left / n, f.right / n, f.bottom / n, f.top / n, c.perspectiveHead};
    }

    void addExplanations() {
        for (size_t i = 0; i < plan_.nodes.size(); ++i) {
            const NodePlan& n = plan_.nodes[i];
            const std::string pass = describe(n.pass);
            char area[96];
            std::snprintf(area, sizeof area, "%.9g %.9g %.9g %.9g", n.area->x, n.area->y, n.area->w, n.area->h);
            plan_.explain.push_back(
                "node " + std::to_string(nodesBefore_ + n.node) + " (" + n.where + ") draws for channel \"" +
                nameOf(config_.channels[at(channels_[i])], channels_[i]) + "\" " + (pass.empty() ? "" : pass + ", ") +
                isRestarting(n) + "the part [ " + area + " ] of the wall" + shownElsewhere(n));
        }
    }

    static std::string isRestarting(const NodePlan& n) {
        if (n.transferScale.none()) return {};
        char text[64];
        std::snprintf(text, sizeof text, "transferred at %.4g by %.4g times the size, ", n.transferScale.x,
                      n.transferScale.y);
        return text;
    }
    static std::string shownElsewhere(const NodePlan& n) {
        if (!n.shown) return {};
        char text[112];
        std::snprintf(text, sizeof text, ", shown in [ %.9g %.9g %.9g %.9g ]", n.shown->x, n.shown->y, n.shown->w,
                      n.shown->h);
        return text;
    }

    const ResolvedConfig& config_;
    const std::string file_;
    const PlanOptions& options_;
    const Index only_;
    const int nodesBefore_;
    std::set<Index> canvases_; // canvases with content, or the selected one
    FrameInput input_;
    std::vector<Draw> draws_;
    std::vector<int> pictures_;             // per draw
    std::vector<Index> channels_;           // per node
    std::map<Index, std::string> barriers_; // swap barrier by window
    std::set<Index> tooLarge_;              // compounds already reported as too large
    std::set<Index> unlike_;                // destinations already reported for unequal pictures
    Index canvas_ = kNone;
    bool anaglyph_ = false, quad_ = false;
    bool inRoom_ = false;
    SessionPlan plan_;
};

} // namespace

namespace {

std::string nameOf(const ResolvedConfig& config, Index canvas) {
    const std::string& name = config.canvases[at(canvas)].name;
    return "canvas " + (name.empty() ? std::to_string(canvas) : "\"" + name + "\"");
}

// Appends the plan of another canvas. Its nodes draw the program's picture at its own resolution.
void add(SessionPlan& plan, SessionPlan other, CanvasPlan canvas) {
    const auto nodes = static_cast<int>(plan.nodes.size());
    int pictures = picturesOf(plan.wall);
    for (const CanvasPlan& c : plan.canvases) pictures = std::max(pictures, picturesOf(c.wall));
    canvas.wall = std::move(other.wall);
    canvas.nodesShowWall = other.nodesShowWall;
    for (WallPart& part : canvas.wall.parts) part.firstPicture += pictures;
    for (NodePlan& node : other.nodes) {
        node.node += nodes;
        node.collector += nodes;
        node.canvas = static_cast<int>(plan.canvases.size()) + 1;
        node.picture += pictures;
        node.answers = false;
        node.pass.zoom = compose(node.pass.zoom, canvas.shown);
        node.pass.zoom = {std::min(node.pass.zoom.x, kMaxZoom), std::min(node.pass.zoom.y, kMaxZoom)};
        node.pass.shown = canvas.shown;
        if (node.window && node.window->asOnWall) node.window->x += canvas.offsetX;
        plan.nodes.push_back(std::move(node));
    }
    std::ranges::move(other.explain, std::back_inserter(plan.explain));
    std::ranges::move(other.warnings, std::back_inserter(plan.warnings));
    if (!plan.eyeBase) plan.eyeBase = other.eyeBase, plan.focusDistance = other.focusDistance;
    plan.canvases.push_back(std::move(canvas));
}

void addCanvases(const LoadedConfig& loaded, const PlanOptions& options, const Planner& first, SessionPlan& plan) {
    const compound::PixelSize own = first.sizeOf(first.canvas());
    int offsetX = options.width > 0 ? options.width : own.w;
    for (const Index c : first.canvases()) {
        if (c == first.canvas() || c == kNone) continue;
        const std::string name = nameOf(loaded.resolved, c);
        Planner planner(loaded, options, c, static_cast<int>(plan.nodes.size()));
        const compound::PixelSize size = planner.sizeOf(c);
        auto planned = planner.plan();
        if (!planned || size.w <= 0 || own.w <= 0) {
            plan.warnings.push_back(
                name + " is not shown: " +
                (planned ? "its size is unknown; give its channels a viewport in pixels" : planned.error().message));
            continue;
        }
        CanvasPlan canvas;
        canvas.name =
            loaded.resolved.canvases[at(c)].name.empty() ? std::to_string(c) : loaded.resolved.canvases[at(c)].name;
        canvas.shown = {static_cast<double>(size.w) / own.w, static_cast<double>(size.h) / own.h};
        if (canvas.shown.x > kMaxZoom || canvas.shown.y > kMaxZoom) {
            plan.warnings.push_back(name + " has more than " + std::to_string(static_cast<int>(kMaxZoom)) +
                                    " times the pixels of the first canvas in one direction; it is shown with this "
                                    "limit; --canvas shows it alone");
            canvas.shown = {std::min(canvas.shown.x, kMaxZoom), std::min(canvas.shown.y, kMaxZoom)};
        }
        canvas.offsetX = offsetX;
        offsetX += static_cast<int>(std::lround(canvas.shown.x * (options.width > 0 ? options.width : own.w)));
        plan.explain.push_back(name + " shows the program's picture with " + std::to_string(size.w) + "x" +
                               std::to_string(size.h) + " pixels; the first canvas has " + std::to_string(own.w) + "x" +
                               std::to_string(own.h));
        add(plan, std::move(*planned), std::move(canvas));
    }
}

} // namespace

Result<SessionPlan> planOf(const LoadedConfig& loaded, const PlanOptions& options) {
    Planner planner(loaded, options);
    auto plan = planner.plan();
    if (plan) addCanvases(loaded, options, planner, *plan);
    if (plan) std::ranges::copy(fieldsWithoutEffect(loaded.diagnostics), std::back_inserter(plan->warnings));
    return plan;
}

compound::PixelSize wallSizeOf(const LoadedConfig& loaded, const PlanOptions& options) {
    return Planner(loaded, options).wallSize();
}

} // namespace mural
