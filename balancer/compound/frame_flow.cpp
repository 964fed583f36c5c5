#include "balancer/compound/frame_flow.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace mural::compound {

namespace {

// Something that was drawn, as it lies in a buffer or in a picture on its way: rectangles in pixels, which need not be whole.
struct Layer {
    Index context = kNone;
    Viewport from; // in the pixels of the draw, from its corner
    Viewport to;
    Zoom size;     // of its pixels here, to those that were drawn
    Zoom least;    // the smallest that they have been
};

Viewport rectangle(const PixelViewport& v) { return {double(v.x), double(v.y), double(v.w), double(v.h)}; }

// What of the layer lies in a part of where it is.
Layer cut(const Layer& layer, const Viewport& part) {
    Layer c = layer;
    const Viewport rest = relativeTo(part, layer.to);
    c.to = part;
    c.from = compose(layer.from, rest);
    return c;
}

using Layers = std::vector<Layer>;

Layers within(const Layers& layers, const Viewport& area) {
    Layers inside;
    for (const Layer& l : layers)
        if (const Viewport both = intersect(l.to, area); !both.empty()) inside.push_back(cut(l, both));
    return inside;
}

// All but what `goes` says, in an area: what is left of a layer are up to four rectangles around it.
template <class Goes> void remove(Layers& layers, const Viewport& area, Goes&& goes) {
    Layers left;
    for (const Layer& l : layers) {
        const Viewport both = goes(l) ? intersect(l.to, area) : Viewport{0, 0, 0, 0};
        if (both.empty()) {
            left.push_back(l);
            continue;
        }
        const double x0 = l.to.x, x1 = l.to.x + l.to.w, y0 = l.to.y, y1 = l.to.y + l.to.h;
        const double bx1 = both.x + both.w, by1 = both.y + both.h;
        for (const Viewport& rest : {Viewport{x0, y0, l.to.w, both.y - y0}, Viewport{x0, by1, l.to.w, y1 - by1}, Viewport{x0, both.y, both.x - x0, both.h}, Viewport{bx1, both.y, x1 - bx1, both.h}}) {
            constexpr double kNothing = 1e-6; // pixels
            if (rest.w > kNothing && rest.h > kNothing) left.push_back(cut(l, rest));
        }
    }
    layers = std::move(left);
}

bool isSteered(const config::ResolvedFrame& f) { return !f.viewport.full() || f.zoom.has_value(); }

class Walk {
public:
    Walk(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan) : config_(config), input_(input), plan_(plan), flows_(plan.contexts.size()), frames_(plan.frames.size()), ready_(plan.frames.size(), false) {}

    std::vector<Flow> run() {
        for (size_t c = 0; c < flows_.size(); ++c) {
            const Tree& tree = treeOf(rootOf(plan_.contexts[c].compound));
            flows_[c].steered = tree.steers && !tree.queues;
            flows_[c].ignored = tree.steers && tree.queues;
        }
        if (std::ranges::none_of(flows_, &Flow::steered)) return flows_;
        std::vector<size_t> next(plan_.pipes.size(), 0);
        for (bool moved = true; moved;) {
            moved = false;
            for (size_t p = 0; p < next.size(); ++p)
                while (next[p] < plan_.pipes[p].size() && perform(plan_.pipes[p][next[p]])) {
                    ++next[p];
                    moved = true;
                }
        }
        for (size_t p = 0; p < next.size(); ++p)
            if (next[p] < plan_.pipes[p].size()) return std::vector<Flow>(plan_.contexts.size()); // it stands still, which was said when the file was checked
        return flows_;
    }

private:
    [[nodiscard]] Index rootOf(Index compound) const {
        while (config_.compounds[at(compound)].parent != kNone) compound = config_.compounds[at(compound)].parent;
        return compound;
    }

    struct Tree {
        bool steers = false; // some frame of it has a viewport or a zoom
        bool queues = false; // tiles of a queue are frames of their own, wherever they lie
    };
    const Tree& treeOf(Index root) {
        const auto [known, fresh] = trees_.try_emplace(root);
        Tree& tree = known->second;
        std::vector<Index> open{root};
        while (fresh && !open.empty()) {
            const config::ResolvedCompound& c = config_.compounds[at(open.back())];
            open.pop_back();
            tree.steers = tree.steers || std::ranges::any_of(c.outputFrames, isSteered) || std::ranges::any_of(c.inputFrames, isSteered);
            tree.queues = tree.queues || !c.outputQueues.empty() || !c.inputQueues.empty();
            open.insert(open.end(), c.children.begin(), c.children.end());
        }
        return tree;
    }

    // A buffer for each window and eye; channels that need one of their own have it.
    Layers& bufferOf(const RenderContext& c) {
        const Index window = config_.channels[at(c.channel)].window;
        return plan_.interleaved ? buffers_[{true, c.channel, c.eye}] : buffers_[{false, window, c.eye}];
    }

    // False: it waits for a picture.
    bool perform(const PipeStep& step) {
        const std::vector<PlannedTask>& tasks = plan_.channels[step.channel].tasks;
        const PlannedTask& task = tasks[step.task];
        const RenderContext& c = plan_.contexts[at(task.context)];
        for (const FrameUse& use : task.inputs)
            if (!ready_[at(use.frame)]) return false;
        Layers& buffer = bufferOf(c);
        switch (task.kind) {
        case Task::Clear: remove(buffer, rectangle(c.viewport), [](const Layer&) { return true; }); break;
        case Task::Draw: buffer.push_back({task.context, {0, 0, double(c.viewport.w), double(c.viewport.h)}, rectangle(c.viewport), {}, {}}); break;
        case Task::Assemble:
            for (const FrameUse& use : task.inputs)
                if (plan_.frames[at(use.frame)].channel == c.channel) takeAway(buffer, use);
            for (const FrameUse& use : task.inputs) assemble(buffer, use);
            break;
        case Task::Readback:
            for (const Index f : task.outputs) readBack(buffer, f);
            break;
        }
        if (step.task + 1 == tasks.size()) take(plan_.channels[step.channel].channel);
        return true;
    }

    void readBack(const Layers& buffer, Index f) {
        const PlannedFrame& frame = plan_.frames[at(f)];
        const Viewport area = rectangle(frame.area);
        const Zoom smaller{frame.size.w / area.w, frame.size.h / area.h}; // in whole pixels
        Layers& picture = frames_[at(f)];
        picture = within(buffer, area);
        for (Layer& l : picture) scale(l, {smaller.x * (l.to.x - area.x), smaller.y * (l.to.y - area.y), l.to.w * smaller.x, l.to.h * smaller.y}, smaller);
        ready_[at(f)] = true;
    }

    static void scale(Layer& l, const Viewport& to, const Zoom& by) {
        l.to = to;
        l.size = compose(l.size, by);
        l.least = {std::min(l.least.x, l.size.x), std::min(l.least.y, l.size.y)};
    }

    // Where a picture of so many pixels comes to lie. Of pixels that lie apart: all from the first to behind the last.
    static Viewport placed(const FrameUse& use, const Viewport& in) {
        const double x = use.zoom.x * use.kernel.w, y = use.zoom.y * use.kernel.h;
        return {use.x + in.x * x, use.y + in.y * y, in.w * x, in.h * y};
    }
    [[nodiscard]] Viewport touched(const FrameUse& use) const {
        const PlannedFrame& frame = plan_.frames[at(use.frame)];
        return intersect(placed(use, {0, 0, double(frame.size.w), double(frame.size.h)}), rectangle(use.clip));
    }

    // It was read back here, and stands for what is there.
    void takeAway(Layers& buffer, const FrameUse& use) const {
        const Layers& picture = frames_[at(use.frame)];
        remove(buffer, touched(use), [&](const Layer& l) { return std::ranges::any_of(picture, [&](const Layer& p) { return p.context == l.context; }); });
    }

    // Whole pictures come in place of what was there; ranges, samples and every nth pixel are joined with it.
    void assemble(Layers& buffer, const FrameUse& use) const {
        const PlannedFrame& frame = plan_.frames[at(use.frame)];
        const bool replaces = !frame.buffers.has(config::Buffer::Depth) && frame.range.full() && frame.subPixel.whole() && frame.pixel.whole();
        if (replaces) remove(buffer, touched(use), [](const Layer&) { return true; });
        Layers moved = frames_[at(use.frame)];
        for (Layer& l : moved) scale(l, placed(use, l.to), use.zoom);
        for (Layer& l : within(moved, rectangle(use.clip))) buffer.push_back(l);
    }

    // A destination that is done is shown.
    void take(Index channel) {
        const PixelViewport& shown = input_.sizes.channels[at(channel)];
        std::set<const Layers*> taken;
        for (const RenderContext& c : plan_.contexts) {
            if (c.channel != channel || c.destination != channel || !taken.insert(&bufferOf(c)).second) continue;
            for (const Layer& l : within(bufferOf(c), rectangle(shown))) {
                if (plan_.contexts[at(l.context)].destination != channel || !flows_[at(l.context)].steered) continue;
                const ShownPart part = partOf(l, shown);
                if (!part.from.empty()) flows_[at(l.context)].parts.push_back(part);
            }
        }
    }

    // In one direction: where pixels stand among the destination's, which ends at `end`, and how wide all that they stand for is.
    struct Place {
        const PixelAxis& axis;
        double origin;
        int32_t pixels;
        double end;
        [[nodiscard]] double width() const { return pixels * axis.scale * axis.step; }
    };

    // Edges may miss each other by what is rounded: zoomed areas have whole pixels of their own.
    static void settle(double& from, double& fromSize, double& to, double& toSize, const Place& place) {
        constexpr double kArithmetic = .01;
        const double rounded = ((place.axis.scale == 1 ? 0 : (1 + place.axis.scale) / 2) + kArithmetic) / place.width();
        double from1 = from + fromSize, to1 = to + toSize;
        if (place.axis.step > 1 && place.axis.scale == 1 && std::abs(to - from) * place.pixels < 1 && std::abs(to1 - from1) * place.pixels < 1) {
            settleNth(from, from1, place);
            to = from, to1 = from1;
        }
        if (std::abs(from) < rounded) from = 0;
        if (std::abs(from1 - 1) < rounded) from1 = 1;
        if (std::abs(to) < rounded) to = 0;
        if (std::abs(to1 - 1) < rounded) to1 = 1;
        if (std::abs(to - from) < rounded && std::abs(to1 - from1) < rounded) to = from, to1 = from1;
        fromSize = from1 - from, toSize = to1 - to;
    }

    // Of every nth pixel it is those that count, not all that they stand for: the last one may stand for some behind the destination.
    static void settleNth(double& from, double& from1, const Place& place) {
        const auto middle = [&](int32_t pixel) { return place.origin + place.axis.kernel + place.axis.step * pixel + .5; };
        const double begin = place.origin + from * place.width(), end = place.origin + from1 * place.width();
        int32_t first = 0, behind = place.pixels;
        while (first < behind && middle(first) < begin) ++first;
        while (behind > first && middle(behind - 1) > std::min(end, place.end)) --behind;
        const bool all = behind == place.pixels || middle(behind) > place.end;
        from = first / static_cast<double>(place.pixels);
        from1 = behind > first && all ? 1 : behind / static_cast<double>(place.pixels);
    }

    [[nodiscard]] ShownPart partOf(const Layer& l, const PixelViewport& shown) const {
        const RenderContext& c = plan_.contexts[at(l.context)];
        const Place x{c.x, shown.x + c.x.origin, c.viewport.w, static_cast<double>(shown.right())}, y{c.y, shown.y + c.y.origin, c.viewport.h, static_cast<double>(shown.top())};
        ShownPart part;
        part.from = {l.from.x / c.viewport.w, l.from.y / c.viewport.h, l.from.w / c.viewport.w, l.from.h / c.viewport.h};
        part.to = {(l.to.x - x.origin) / x.width(), (l.to.y - y.origin) / y.width(), l.to.w / x.width(), l.to.h / y.width()};
        settle(part.from.x, part.from.w, part.to.x, part.to.w, x);
        settle(part.from.y, part.from.h, part.to.y, part.to.h, y);
        part.way = {wayOf(l.size.x, l.least.x), wayOf(l.size.y, l.least.y)};
        return part;
    }

    // What is drawn larger than it is shown, or smaller, loses nothing by that alone.
    static double wayOf(double size, double least) { return least < std::min(1., size) - 1e-9 ? least / size : 1; }

    const ResolvedConfig& config_;
    const FrameInput& input_;
    const FramePlan& plan_;
    std::vector<Flow> flows_;
    std::vector<Layers> frames_;
    std::vector<bool> ready_;
    std::map<Index, Tree> trees_; // by their root
    std::map<std::tuple<bool, Index, Eye>, Layers> buffers_;
};

} // namespace

std::vector<Flow> flowOf(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan) { return Walk(config, input, plan).run(); }

} // namespace mural::compound
