#include "balancer/compound/frame_flow.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace mural::compound {

namespace {

// A drawn image in a buffer or in a transferred frame, as rectangles in pixels that may be fractional.
struct Layer {
    Index context = kNone;
    Viewport from; // in pixels of the draw, relative to its corner
    Viewport to;
    Zoom size;    // scale of its pixels here, relative to the drawn pixels
    Zoom minimum; // smallest scale so far
};

Viewport rectangle(const PixelViewport& v) { return {double(v.x), double(v.y), double(v.w), double(v.h)}; }

// Returns the part of the layer within a part of its area.
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

// Removes the layers that `goes` selects within an area. The remainder of a layer is up to four rectangles around the
// area.
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
        for (const Viewport& rest :
             {Viewport{x0, y0, l.to.w, both.y - y0}, Viewport{x0, by1, l.to.w, y1 - by1},
              Viewport{x0, both.y, both.x - x0, both.h}, Viewport{bx1, both.y, x1 - bx1, both.h}}) {
            constexpr double kNothing = 1e-6; // in pixels
            if (rest.w > kNothing && rest.h > kNothing) left.push_back(cut(l, rest));
        }
    }
    layers = std::move(left);
}

bool isSteered(const config::ResolvedFrame& f) { return !f.viewport.full() || f.zoom.has_value(); }

class Walk {
public:
    Walk(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan)
        : config_(config),
          input_(input),
          plan_(plan),
          flows_(plan.contexts.size()),
          frames_(plan.frames.size()),
          ready_(plan.frames.size(), false) {}

    std::vector<Flow> flows() {
        for (size_t c = 0; c < flows_.size(); ++c) {
            const Tree& tree = treeOf(rootOf(plan_.contexts[c].compound));
            flows_[c].steered = tree.steers && !tree.queues;
            flows_[c].ignored = tree.steers && tree.queues;
        }
        const bool isWhole = std::ranges::none_of(flows_, &Flow::steered) || run();
        return isWhole ? flows_ : std::vector<Flow>(plan_.contexts.size());
    }

    std::vector<ShownCopy> copies() { return run() ? copies_ : std::vector<ShownCopy>{}; }

private:
    // Returns false at a deadlock, which was reported when the file was checked.
    bool run() {
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
            if (next[p] < plan_.pipes[p].size()) return false;
        return true;
    }

    [[nodiscard]] Index rootOf(Index compound) const {
        while (config_.compounds[at(compound)].parent != kNone) compound = config_.compounds[at(compound)].parent;
        return compound;
    }

    struct Tree {
        bool steers = false; // true if one of its frames has a viewport or a zoom
        bool queues = false; // tiles of a queue are separate frames without a fixed place
    };
    const Tree& treeOf(Index root) {
        const auto [known, fresh] = trees_.try_emplace(root);
        Tree& tree = known->second;
        std::vector<Index> open{root};
        while (fresh && !open.empty()) {
            const config::ResolvedCompound& c = config_.compounds[at(open.back())];
            open.pop_back();
            tree.steers = tree.steers || std::ranges::any_of(c.outputFrames, isSteered) ||
                          std::ranges::any_of(c.inputFrames, isSteered);
            tree.queues = tree.queues || !c.outputQueues.empty() || !c.inputQueues.empty();
            open.insert(open.end(), c.children.begin(), c.children.end());
        }
        return tree;
    }

    // One buffer per window and eye. Interleaved channels have a buffer of their own.
    Layers& bufferOf(const RenderContext& c) {
        const Index window = config_.channels[at(c.channel)].window;
        return plan_.interleaved ? buffers_[{true, c.channel, c.eye}] : buffers_[{false, window, c.eye}];
    }

    // Returns false if the step waits for a frame.
    bool perform(const PipeStep& step) {
        const std::vector<PlannedTask>& tasks = plan_.channels[step.channel].tasks;
        const PlannedTask& task = tasks[step.task];
        const RenderContext& c = plan_.contexts[at(task.context)];
        for (const FrameUse& use : task.inputs)
            if (!ready_[at(use.frame)]) return false;
        Layers& buffer = bufferOf(c);
        switch (task.kind) {
        case Task::Clear: remove(buffer, rectangle(c.viewport), [](const Layer&) { return true; }); break;
        case Task::Draw:
            buffer.push_back(
                {task.context, {0, 0, double(c.viewport.w), double(c.viewport.h)}, rectangle(c.viewport), {}, {}});
            break;
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
        const Zoom smaller{frame.size.w / area.w, frame.size.h / area.h}; // rounded to whole pixels
        Layers& picture = frames_[at(f)];
        picture = within(buffer, area);
        for (Layer& l : picture)
            scale(
                l,
                {smaller.x * (l.to.x - area.x), smaller.y * (l.to.y - area.y), l.to.w * smaller.x, l.to.h * smaller.y},
                smaller);
        ready_[at(f)] = true;
    }

    static void scale(Layer& l, const Viewport& to, const Zoom& by) {
        l.to = to;
        l.size = compose(l.size, by);
        l.minimum = {std::min(l.minimum.x, l.size.x), std::min(l.minimum.y, l.size.y)};
    }

    // Returns the area that a frame of this size occupies. With a pixel stride: from the first pixel to one past the
    // last.
    static Viewport placed(const FrameUse& use, const Viewport& in) {
        const double x = use.zoom.x * use.kernel.w, y = use.zoom.y * use.kernel.h;
        return {use.x + in.x * x, use.y + in.y * y, in.w * x, in.h * y};
    }
    [[nodiscard]] Viewport touched(const FrameUse& use) const {
        const PlannedFrame& frame = plan_.frames[at(use.frame)];
        return intersect(placed(use, {0, 0, double(frame.size.w), double(frame.size.h)}), rectangle(use.clip));
    }

    // The frame was read back from this buffer and replaces its contents there.
    void takeAway(Layers& buffer, const FrameUse& use) const {
        const Layers& picture = frames_[at(use.frame)];
        remove(buffer, touched(use), [&](const Layer& l) {
            return std::ranges::any_of(picture, [&](const Layer& p) { return p.context == l.context; });
        });
    }

    // Whole pictures replace the contents of the buffer. Ranges, samples and pixel kernels are combined with it.
    void assemble(Layers& buffer, const FrameUse& use) const {
        const PlannedFrame& frame = plan_.frames[at(use.frame)];
        const bool replaces = !frame.buffers.has(config::Buffer::Depth) && frame.range.full() &&
                              frame.subPixel.whole() && frame.pixel.whole();
        if (replaces) remove(buffer, touched(use), [](const Layer&) { return true; });
        Layers moved = frames_[at(use.frame)];
        for (Layer& l : moved) scale(l, placed(use, l.to), use.zoom);
        for (Layer& l : within(moved, rectangle(use.clip))) buffer.push_back(l);
    }

    // Records the contents of a finished destination channel as shown.
    void take(Index channel) {
        const PixelViewport& shown = input_.sizes.channels[at(channel)];
        std::set<const Layers*> taken;
        for (const RenderContext& c : plan_.contexts) {
            if (c.channel != channel || c.destination != channel || !taken.insert(&bufferOf(c)).second) continue;
            for (const Layer& l : within(bufferOf(c), rectangle(shown))) {
                if (plan_.contexts[at(l.context)].destination != channel) {
                    takeCopy(l, channel, shown);
                    continue;
                }
                if (!flows_[at(l.context)].steered) continue;
                const ShownPart part = partOf(l, shown);
                if (!part.from.empty()) flows_[at(l.context)].parts.push_back(part);
            }
        }
    }

    void takeCopy(const Layer& l, Index channel, const PixelViewport& shown) {
        const RenderContext& c = plan_.contexts[at(l.context)];
        if (c.eye == Eye::Right || c.viewport.empty()) return;
        const Viewport drawn{0, 0, double(c.viewport.w), double(c.viewport.h)};
        copies_.push_back({l.context, channel, relativeTo(l.from, drawn), relativeTo(l.to, rectangle(shown))});
    }

    // One axis: the position of pixels among those of the destination, which ends at `end`, and the width that they
    // represent.
    struct Place {
        const PixelAxis& axis;
        double origin;
        int32_t pixels;
        double end;
        [[nodiscard]] double width() const { return pixels * axis.scale * axis.step; }
    };

    // Tolerates rounding at edges, because zoomed areas are rounded to whole pixels.
    static void settle(double& from, double& fromSize, double& to, double& toSize, const Place& place) {
        constexpr double kArithmetic = .01;
        const double rounded = ((place.axis.scale == 1 ? 0 : (1 + place.axis.scale) / 2) + kArithmetic) / place.width();
        double from1 = from + fromSize, to1 = to + toSize;
        if (place.axis.step > 1 && place.axis.scale == 1 && std::abs(to - from) * place.pixels < 1 &&
            std::abs(to1 - from1) * place.pixels < 1) {
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

    // With a pixel stride only the pixels themselves count, not the blocks that they represent: the last block may
    // extend past the destination.
    static void settleNth(double& from, double& from1, const Place& place) {
        const auto middle = [&](int32_t pixel) {
            return place.origin + place.axis.kernel + place.axis.step * pixel + .5;
        };
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
        const Place x{c.x, shown.x + c.x.origin, c.viewport.w, static_cast<double>(shown.right())},
            y{c.y, shown.y + c.y.origin, c.viewport.h, static_cast<double>(shown.top())};
        ShownPart part;
        part.from = {l.from.x / c.viewport.w, l.from.y / c.viewport.h, l.from.w / c.viewport.w,
                     l.from.h / c.viewport.h};
        part.to = {(l.to.x - x.origin) / x.width(), (l.to.y - y.origin) / y.width(), l.to.w / x.width(),
                   l.to.h / y.width()};
        settle(part.from.x, part.from.w, part.to.x, part.to.w, x);
        settle(part.from.y, part.from.h, part.to.y, part.to.h, y);
        part.transferScale = {transferScaleOf(l.size.x, l.minimum.x), transferScaleOf(l.size.y, l.minimum.y)};
        return part;
    }

    // A picture drawn larger or smaller than shown loses no resolution by that alone.
    static double transferScaleOf(double size, double minimum) {
        return minimum < std::min(1., size) - 1e-9 ? minimum / size : 1;
    }

    const ResolvedConfig& config_;
    const FrameInput& input_;
    const FramePlan& plan_;
    std::vector<Flow> flows_;
    std::vector<ShownCopy> copies_;
    std::vector<Layers> frames_;
    std::vector<bool> ready_;
    std::map<Index, Tree> trees_; // by root compound
    std::map<std::tuple<bool, Index, Eye>, Layers> buffers_;
};

} // namespace

std::vector<Flow> flowOf(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan) {
    return Walk(config, input, plan).flows();
}

std::vector<ShownCopy> copiesOf(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan) {
    std::map<Index, Index> destinations; // by compound
    for (const RenderContext& c : plan.contexts) destinations.emplace(c.compound, c.destination);
    const auto isOfOthers = [&](const PlannedTask& task, const FrameUse& use) {
        const auto producer = destinations.find(plan.frames[at(use.frame)].compound);
        return producer != destinations.end() && producer->second != plan.contexts[at(task.context)].destination;
    };
    for (const ChannelPlan& channel : plan.channels)
        for (const PlannedTask& task : channel.tasks)
            for (const FrameUse& use : task.inputs)
                if (isOfOthers(task, use)) return Walk(config, input, plan).copies();
    return {}; // all frames come from channels of their own destination, the usual case
}

} // namespace mural::compound
