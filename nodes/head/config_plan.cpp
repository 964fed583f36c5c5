#include "nodes/head/config_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "balancer/compound/even_split.hpp"
#include "balancer/compound/frusta.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "nodes/head/compound_pass.hpp"
#include "nodes/head/config_gaps.hpp"
#include "nodes/pictures/plane_codecs.hpp"

namespace mural {

namespace {

using compound::FrameInput;
using compound::FramePlan;
using compound::LoadedConfig;
using compound::RenderContext;
using config::Index;
using config::kNone;
using config::ResolvedConfig;

constexpr uint32_t kMostTurns = 64; // of periods that have no common end

size_t at(Index index) { return ResolvedConfig::at(index); }

// One draw of the compound tree.
struct Draw {
    RenderContext context;
    Viewport area; // of the canvas
    int queue = -1, chunkQueue = -1; // of the plan
};

std::string nameOf(const config::ResolvedChannel& channel, Index index) { return channel.name.empty() ? "channel " + std::to_string(index) : channel.name; }

class Planner {
public:
    Planner(const LoadedConfig& loaded, const ConfigWishes& wishes) : config_(loaded.resolved), file_(loaded.diagnostics.file()), wishes_(wishes) {}

    Result<SessionPlan> plan() {
        if (auto chosen = chooseLayouts(); !chosen) return chosen.error();
        gather();
        if (auto chosen = chooseCanvas(); !chosen) return chosen.error();
        if (draws_.empty()) return Error{file_ + ": nothing of it draws: it has no canvas with segments, or no compound with channels; mural config print --resolved shows what it has"};
        if (auto done = placeParts(); !done) return done.error();
        lookIntoRoom();
        if (auto placed = placeNodes(); !placed) return placed.error();
        placeWindows();
        takeObserver();
        tell();
        return std::move(plan_);
    }

    compound::PixelSize wallSize() {
        if (!chooseLayouts()) return {0, 0};
        const compound::DisplaySizes sizes = compound::displaySizes(config_);
        for (const config::ResolvedCanvas& canvas : config_.canvases) {
            if (!wishes_.canvas.empty() && canvas.name != wishes_.canvas) continue;
            for (const Index s : canvas.segments) {
                const config::ResolvedSegment& segment = config_.segments[at(s)];
                if (segment.channel == kNone || segment.viewport.empty()) continue;
                const PixelViewport& pixels = sizes.channels[at(segment.channel)];
                return {static_cast<int32_t>(std::lround(pixels.w / segment.viewport.w)), static_cast<int32_t>(std::lround(pixels.h / segment.viewport.h))};
            }
        }
        return {0, 0};
    }

private:
    Result<void> chooseLayouts() {
        input_ = compound::firstFrame(config_);
        input_.activeLayouts.resize(config_.canvases.size(), 0);
        input_.views.resize(config_.views.size());
        for (compound::ViewState& view : input_.views) view.modelUnit = wishes_.modelUnit;
        for (const std::string& wanted : wishes_.layouts) {
            bool found = false;
            for (size_t c = 0; c < config_.canvases.size(); ++c) {
                const auto& layouts = config_.canvases[c].layouts;
                for (size_t i = 0; i < layouts.size(); ++i) {
                    if (layouts[i] == kNone || config_.layouts[at(layouts[i])].name != wanted) continue;
                    input_.activeLayouts[c] = static_cast<Index>(i);
                    found = true;
                }
            }
            if (!found) return Error{"--layout \"" + wanted + "\": no canvas of " + file_ + " has such a layout; mural config print shows them"};
        }
        return {};
    }

    // The draws of all turns, each once.
    void gather() {
        uint32_t period = 1;
        for (const config::ResolvedCompound& c : config_.compounds) {
            const uint32_t own = std::max<uint32_t>(1, c.period.value_or(1));
            period = std::min(kMostTurns, std::lcm(period, std::min(own, kMostTurns)));
        }
        std::set<std::tuple<Index, Index, Index, Eye>> seen;
        for (uint32_t frame = 0; frame < period; ++frame) {
            input_.frameNumber = frame;
            const FramePlan plan = compound::planFrame(config_, input_);
            for (const compound::PlannedBarrier& barrier : plan.barriers)
                for (const Index window : barrier.windows) barriers_.try_emplace(window, barrier.name);
            std::map<Index, std::vector<size_t>> workers; // by their queue: their draws
            for (const compound::ChannelPlan& channel : plan.channels) {
                for (const compound::PlannedTask& task : channel.tasks) {
                    if (task.kind != config::Task::Draw || task.context == kNone) continue;
                    const RenderContext& c = plan.contexts[at(task.context)];
                    if (c.view == kNone || !seen.emplace(c.compound, c.destination, c.view, c.eye).second) continue;
                    draws_.push_back({c, compose(config_.views[at(c.view)].viewport, c.part)});
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

    // Each canvas is a wall of its own, and the session shows one.
    Result<void> chooseCanvas() {
        std::set<Index> canvases;
        for (const Draw& d : draws_) canvases.insert(canvasOf(d));
        Index chosen = canvases.empty() ? kNone : *canvases.begin();
        if (!wishes_.canvas.empty()) {
            const auto named = std::find_if(canvases.begin(), canvases.end(), [&](Index c) { return c != kNone && config_.canvases[at(c)].name == wishes_.canvas; });
            if (named == canvases.end()) return Error{"--canvas \"" + wishes_.canvas + "\": " + file_ + " shows nothing on a canvas of this name; mural config print shows them"};
            chosen = *named;
        } else if (canvases.size() > 1) {
            plan_.warnings.push_back(file_ + ": of its " + std::to_string(canvases.size()) + " canvases the first is shown; --canvas NAME shows another");
        }
        std::erase_if(draws_, [&](const Draw& d) { return canvasOf(d) != chosen; });
        canvas_ = chosen;
        return {};
    }

    // Queues begin dealt out evenly, in strips of the picture or of the range; tiles are taken by who is free, then.
    void dealOut(const FramePlan& plan, const compound::PlannedQueue& queue, const std::vector<size_t>& draws) {
        const RenderContext& divided = plan.contexts[at(queue.context)];
        const bool chunks = !queue.tiles.empty() && std::any_of(queue.tiles.begin(), queue.tiles.end(), [&](const compound::PlannedTile& t) { return t.range != divided.range; });
        const double n = static_cast<double>(draws.size());
        for (size_t i = 0; i < draws.size(); ++i) {
            Draw& d = draws_[draws[i]];
            const double from = static_cast<double>(i) / n, to = static_cast<double>(i + 1) / n;
            const Viewport whole = compose(config_.views[at(divided.view)].viewport, divided.part);
            d.area = chunks ? whole : compose(whole, Viewport{0, from, 1, to - from});
            d.context.range = chunks ? compose(divided.range, Range{from, to}) : divided.range;
        }
        if (queue.tiles.empty()) return;
        if (chunks) {
            for (const size_t d : draws) draws_[d].chunkQueue = static_cast<int>(plan_.chunkQueues.size());
            plan_.chunkQueues.push_back({queue.name, divided.range, queue.tiles.front().range.end - queue.tiles.front().range.start});
            return;
        }
        TileQueuePlan planned{queue.name, compose(config_.views[at(divided.view)].viewport, divided.part), 0, 0};
        for (const compound::PlannedTile& tile : queue.tiles) {
            planned.width = std::max(planned.width, tile.area.w);
            planned.height = std::max(planned.height, tile.area.h);
        }
        for (const size_t d : draws) draws_[d].queue = static_cast<int>(plan_.queues.size());
        plan_.queues.push_back(planned);
    }

    // Destinations with their eyes, and which pictures they are made of.
    Result<void> placeParts() {
        using Key = std::tuple<Index, Eye>;
        std::map<Key, std::vector<size_t>> parts;
        for (size_t i = 0; i < draws_.size(); ++i) parts[{draws_[i].context.destination, draws_[i].context.eye}].push_back(i);
        int next = 0;
        for (const auto& [key, draws] : parts) {
            const RenderContext& first = draws_[draws.front()].context;
            const config::ResolvedChannel& channel = config_.channels[at(first.destination)];
            WallPart part;
            part.name = nameOf(channel, first.destination);
            part.eye = first.eye;
            using config::ColorComponent;
            part.colours = {first.eyeColors.has(ColorComponent::Red), first.eyeColors.has(ColorComponent::Green), first.eyeColors.has(ColorComponent::Blue)};
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
                    return Error{file_ + ":" + std::to_string(config_.compounds[at(c.compound)].at.line) + ": channel \"" + part.name + "\" is put together of parts with different pixel or subpixel kernels; give all of them the same"};
                const int picture = next + pictureOf(n, passOf(config_, c));
                pictures_.resize(draws_.size(), 0);
                pictures_[i] = picture;
                made.insert(picture);
            }
            if (static_cast<int>(made.size()) < picturesOf(part.counts))
                plan_.warnings.push_back(file_ + ": channel \"" + part.name + "\": some pixels or samples of its kernel are drawn by no compound, they stay black");
            next += picturesOf(part.counts);
            if (first.stereoMode == compound::StereoMode::Anaglyph) anaglyph_ = true;
            if (first.stereoMode == compound::StereoMode::Quad && first.eye == Eye::Left)
                plan_.warnings.push_back(placeOf(first.compound) + ": channel \"" + part.name + "\" wants a quad-buffered pair; no window here has one, so both eyes are shown side by side; a display that takes such pairs, or stereo_mode ANAGLYPH, shows them");
            plan_.wall.parts.push_back(part);
        }
        plan_.wall.stereo = anaglyph_ ? StereoMode::Anaglyph : StereoMode::SideBySide;
        return {};
    }

    // The box of all that is drawn for it.
    [[nodiscard]] Viewport destinationArea(const std::vector<size_t>& draws) const {
        double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
        for (const size_t i : draws) {
            const Viewport& a = draws_[i].area;
            x0 = std::min(x0, a.x);
            y0 = std::min(y0, a.y);
            x1 = std::max(x1, a.x + a.w);
            y1 = std::max(y1, a.y + a.h);
        }
        return {x0, y0, x1 - x0, y1 - y0};
    }

    // Nodes in the order of their groups: draws of one area of one picture that differ in their range alone.
    Result<void> placeNodes() {
        using Key = std::tuple<int, uint32_t, double, double, double, double>;
        std::map<Key, std::vector<size_t>> groups;
        for (size_t i = 0; i < draws_.size(); ++i) {
            const Viewport& a = draws_[i].area;
            groups[{pictures_[i], draws_[i].context.phase, a.x, a.y, a.w, a.h}].push_back(i);
        }
        for (auto& [key, draws] : groups) {
            std::sort(draws.begin(), draws.end(), [&](size_t a, size_t b) { return draws_[a].context.range.start < draws_[b].context.range.start; });
            const auto collector = static_cast<int>(plan_.nodes.size());
            int rank = 0;
            for (const size_t i : draws) {
                const RenderContext& c = draws_[i].context;
                NodePlan node;
                node.node = static_cast<int>(plan_.nodes.size());
                node.pass = passOf(config_, c);
                tellTooLarge(c.compound);
                if (node.pass.zoom != passOf(config_, draws_[draws.front()].context).zoom)
                    return Error{file_ + ":" + std::to_string(config_.compounds[at(c.compound)].at.line) + ": ranges of one picture are zoomed differently and can't be put together by depth; give all of them the same zoom"};
                node.pass.range = rank++;
                node.pass.ranges = static_cast<int>(draws.size());
                node.picture = pictures_[i];
                node.area = draws_[i].area;
                node.queue = draws_[i].queue;
                node.chunkQueue = draws_[i].chunkQueue;
                node.screen = screenOf(c);
                node.collector = collector;
                if (auto named = takeComposition(node, config_.compounds[at(c.compound)]); !named) return named;
                if (auto named = takeCodec(node, c.compound); !named) return named;
                node.answers = node.pass.range == 0 && c.eye != Eye::Right && c.pixel.x == 0 && c.pixel.y == 0 && c.subPixel.index == 0;
                placeOnHost(node, c);
                plan_.nodes.push_back(node);
                channels_.push_back(c.channel);
            }
        }
        return {};
    }

    // Of a compound in the file, for lines about it.
    [[nodiscard]] std::string placeOf(Index compound) const {
        const config::SourcePosition& there = config_.compounds[at(compound)].at;
        return file_ + ":" + std::to_string(there.line) + ":" + std::to_string(there.column);
    }

    void tellTooLarge(Index compound) {
        const Zoom zoom = zoomOf(config_, compound);
        if ((zoom.x <= kMostZoom && zoom.y <= kMostZoom) || !tooLarge_.insert(compound).second) return;
        plan_.warnings.push_back(placeOf(compound) + ": nodes draw at most " + std::to_string(static_cast<int>(kMostZoom)) + " times as large as they show; give a smaller zoom");
    }

    // Where a file says nothing, the number of nodes does, later.
    [[nodiscard]] Result<void> takeComposition(NodePlan& node, const config::ResolvedCompound& compound) const {
        if (compound.composition.empty() || compound.composition == "auto") return {};
        node.composition = compositor::strategyNamed(compound.composition);
        if (node.composition) return {};
        std::string names = "auto";
        for (const compositor::Strategy s : compositor::kEveryStrategy) names += std::string(", ") + nameOf(s);
        return Error{file_ + ":" + std::to_string(compound.at.line) + ": mural_composition \"" + compound.composition + "\": must be one of " + names};
    }

    [[nodiscard]] Index rootOf(Index compound) const {
        while (config_.compounds[at(compound)].parent != kNone) compound = config_.compounds[at(compound)].parent;
        return compound;
    }

    // Of the pictures that it hands out; who takes one may say otherwise for its own.
    [[nodiscard]] Result<void> takeCodec(NodePlan& node, Index compound) const {
        for (const config::ResolvedFrame& given : config_.compounds[at(compound)].outputFrames) {
            const config::ResolvedFrame* said = &given;
            bool exact = given.exact;
            for (size_t taker = 0; taker < config_.compounds.size(); ++taker)
                for (const config::ResolvedFrame& taken : config_.compounds[taker].inputFrames) {
                    if (taken.name != given.name || rootOf(static_cast<Index>(taker)) != rootOf(compound)) continue;
                    exact = exact && taken.exact;
                    if (taken.codec != kQuickestCodec) said = &taken;
                }
            const std::string place = file_ + ":" + std::to_string(said->at.line) + ": mural_codec \"" + said->codec + "\"";
            auto wanted = wantedCodec(said->codec);
            if (!wanted) return Error{place + ": " + wanted.error().message};
            if (!wanted->lossless && exact) return Error{place + " loses something; say mural_exact OFF in the same frame, or take another codec"};
            node.codec = said->codec == kQuickestCodec && !exact ? kLossyCodec : said->codec;
        }
        return {};
    }

    void placeOnHost(NodePlan& node, const RenderContext& c) const {
        const config::ResolvedPipe& pipe = config_.pipeOf(config_.channels[at(c.channel)]);
        const config::ResolvedNode& machine = config_.nodes[at(pipe.node)];
        node.where = "local";
        if (wishes_.here || machine.isApplication || machine.host.empty()) return;
        node.where = machine.host;
        node.reach = reachOf(machine.host, wishes_.ownHost);
    }

    // Nodes show what they draw where the file has their channel's window, if every channel of the wall is drawn by its own
    // node as it is shown. Otherwise the head shows the wall.
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
            if (!plain || pictures != 1 || drawer->pass.period > 1 || !same(*drawer->area, part.area) || !isDestination(*drawer)) return headShowsIt();
            shows.push_back(drawer);
        }
        for (size_t a = 0; a < shows.size(); ++a)
            for (size_t b = 0; b < a; ++b) {
                const bool sameChannel = channels_[node(*shows[a])] == channels_[node(*shows[b])];
                if (sameChannel || (wishes_.here && !intersect(*shows[a]->area, *shows[b]->area).empty())) return headShowsIt();
            }
        for (NodePlan* n : shows) {
            const Index channel = channels_[node(*n)];
            n->window = windowOf(channel);
            if (const auto barrier = barriers_.find(config_.channels[at(channel)].window); barrier != barriers_.end()) n->swapBarrier = barrier->second;
        }
    }

    static bool same(const Viewport& a, const Viewport& b) {
        constexpr double kRounding = 1e-9;
        return std::abs(a.x - b.x) < kRounding && std::abs(a.y - b.y) < kRounding && std::abs(a.w - b.w) < kRounding && std::abs(a.h - b.h) < kRounding;
    }
    void headShowsIt() { plan_.nodesShowWall = false; }
    static size_t node(const NodePlan& n) { return static_cast<size_t>(n.node); }

    [[nodiscard]] bool isDestination(const NodePlan& n) const { return config_.channels[at(channels_[node(n)])].isDestination(); }

    // With all nodes here windows lie as on the wall, as a picture of it.
    [[nodiscard]] NodeWindow windowOf(Index index) const {
        const config::ResolvedChannel& channel = config_.channels[at(index)];
        const config::ResolvedWindow& window = config_.windows[at(channel.window)];
        const config::ResolvedPipe& pipe = config_.pipes[at(window.pipe)];
        NodeWindow shown;
        shown.title = "Mural " + nameOf(channel, index);
        if (wishes_.here) return shown;
        const compound::DisplaySizes& sizes = input_.sizes;
        shown.asOnWall = false;
        shown.x = sizes.windows[at(channel.window)].x + sizes.channels[at(index)].x;
        shown.y = sizes.windows[at(channel.window)].y + sizes.channels[at(index)].y;
        shown.fullScreen = window.attributes.hintFullscreen == config::value::kOn;
        if (pipe.device || pipe.port) shown.displayName = ":" + std::to_string(pipe.port.value_or(0)) + "." + std::to_string(pipe.device.value_or(0));
        return shown;
    }

    // Of the first view in stereo.
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

    // Screens that look another way than the first one.
    [[nodiscard]] bool standAtAngles() const {
        const auto normal = [](const RenderContext& c) { return transformDirection(rigidInverse(c.perspectiveHead), {0, 0, 1}); };
        return std::any_of(draws_.begin(), draws_.end(), [&](const Draw& d) { return dot(normal(d.context), normal(draws_.front().context)) < 1 - 1e-6; });
    }

    void lookIntoRoom() {
        const bool atAngles = standAtAngles();
        inRoom_ = wishes_.frusta == Frusta::Room || (wishes_.frusta == Frusta::Auto && atAngles);
        if (inRoom_) plan_.explain.push_back(std::string(atAngles ? "its screens stand at angles to each other: " : "") + "each screen shows the scene from the observer's eyes (--frusta program: all of them one flat picture)");
        else if (atAngles) plan_.explain.push_back("its screens stand at angles to each other; the program's picture is laid over them as over a flat wall (--frusta program)");
        if (!inRoom_) return;
        std::set<Index> behind;
        for (const Draw& d : draws_)
            if (d.context.behindScreen && behind.insert(d.context.destination).second)
                plan_.warnings.push_back(file_ + ": the observer's eyes are behind the screen of channel \"" + nameOf(config_.channels[at(d.context.destination)], d.context.destination) + "\"; it shows its part of the program's own picture");
    }

    [[nodiscard]] std::optional<ScreenView> screenOf(const RenderContext& c) const {
        if (!inRoom_ || c.behindScreen) return {};
        const Frustum& f = c.destinationPerspective;
        const double n = f.nearPlane;
        const Viewport area = compose(config_.views[at(c.view)].viewport, compound::coverage(config_, config_.channels[at(c.destination)]));
        return ScreenView{area, f.left / n, f.right / n, f.bottom / n, f.top / n, c.perspectiveHead};
    }

    void tell() {
        for (size_t i = 0; i < plan_.nodes.size(); ++i) {
            const NodePlan& n = plan_.nodes[i];
            const std::string pass = describe(n.pass);
            char area[96];
            std::snprintf(area, sizeof area, "%.9g %.9g %.9g %.9g", n.area->x, n.area->y, n.area->w, n.area->h);
            plan_.explain.push_back("node " + std::to_string(n.node) + " (" + n.where + ") draws for channel \"" + nameOf(config_.channels[at(channels_[i])], channels_[i]) + "\" " +
                                    (pass.empty() ? "" : pass + ", ") + "the part [ " + area + " ] of the wall");
        }
    }

    const ResolvedConfig& config_;
    const std::string file_;
    const ConfigWishes& wishes_;
    FrameInput input_;
    std::vector<Draw> draws_;
    std::vector<int> pictures_;   // of each draw
    std::vector<Index> channels_; // of each node
    std::map<Index, std::string> barriers_; // by window: the swap barrier that it waits at
    std::set<Index> tooLarge_;    // compounds of which was said that they are
    Index canvas_ = kNone;
    bool anaglyph_ = false;
    bool inRoom_ = false;
    SessionPlan plan_;
};

} // namespace

Result<SessionPlan> planOf(const LoadedConfig& loaded, const ConfigWishes& wishes) {
    auto plan = Planner(loaded, wishes).plan();
    if (plan) std::ranges::copy(fieldsWithoutEffect(loaded.diagnostics), std::back_inserter(plan->warnings));
    return plan;
}

compound::PixelSize wallSizeOf(const LoadedConfig& loaded, const ConfigWishes& wishes) { return Planner(loaded, wishes).wallSize(); }

} // namespace mural
