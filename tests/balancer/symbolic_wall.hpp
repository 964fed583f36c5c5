// Executes a plan without drawing: each pixel stores its draws, and the destination pixel for which each was drawn. At
// the end every shown pixel must contain its own draws, with the complete range and every subpixel once.
#pragma once

#include <algorithm>
#include <map>
#include <string>

#include "balancer/compound/frame_plan.hpp"
#include "balancer/compound/tiles.hpp"

namespace mural::compound::testing {

// One contribution to a pixel.
struct Share {
    int32_t x, y; // intended destination pixel, from the destination's corner
    Range range;
    SubPixel sample;
    Index destination;
    Index context = kNone; // the context that drew it; none: drawn as tiles
};
using Pixel = std::vector<Share>;

struct Picture {
    std::map<std::pair<int32_t, int32_t>, Pixel> pixels;
};

class SymbolicWall {
public:
    SymbolicWall(const ResolvedConfig& config, const FrameInput& input, const FramePlan& plan)
        : config_(config), input_(input), plan_(plan) {}

    // The final content of every destination, by its eyes: pixels of its window.
    std::map<std::pair<Index, Eye>, std::map<std::pair<int32_t, int32_t>, Pixel>> shown;

    // Returns the first error, or an empty string if everything was drawn once.
    std::string run() {
        if (!plan_.deadlock.empty()) return "deadlock";
        frames_.resize(plan_.frames.size());
        ready_.assign(plan_.frames.size(), false);
        std::vector<size_t> next(plan_.pipes.size(), 0);
        for (bool moved = true; moved;) {
            moved = false;
            for (size_t p = 0; p < next.size(); ++p) {
                while (next[p] < plan_.pipes[p].size() && perform(plan_.pipes[p][next[p]])) {
                    ++next[p];
                    moved = true;
                }
            }
        }
        if (!fault_.empty()) return fault_;
        for (size_t p = 0; p < next.size(); ++p) {
            if (next[p] < plan_.pipes[p].size())
                return "pipe " + std::to_string(p) + " stands still at its task " + std::to_string(next[p]);
        }
        return {};
    }

private:
    using Pixels = std::map<std::pair<int32_t, int32_t>, Pixel>;

    // One buffer per window and eye; interleaved channels have their own.
    Pixels& pixelsOf(const RenderContext& c) {
        const Index window = config_.channels[ResolvedConfig::at(c.channel)].window;
        return buffers_[{plan_.interleaved ? c.channel + 100'000 : window, c.eye}];
    }

    bool perform(const PipeStep& step) {
        const PlannedTask& task = plan_.channels[step.channel].tasks[step.task];
        const RenderContext& c = plan_.contexts[ResolvedConfig::at(task.context)];
        for (const FrameUse& use : task.inputs) {
            if (!ready_[ResolvedConfig::at(use.frame)]) return false;
        }
        switch (task.kind) {
        case Task::Clear: clear(c); break;
        case Task::Draw: draw(task, c); break;
        case Task::Assemble:
            for (const FrameUse& use : task.inputs) {
                if (plan_.frames[ResolvedConfig::at(use.frame)].channel == c.channel) assemble(c, use, true);
            }
            for (const FrameUse& use : task.inputs) assemble(c, use, false);
            break;
        case Task::Readback:
            for (const Index f : task.outputs) readBack(c, f);
            break;
        }
        if (step.task + 1 == plan_.channels[step.channel].tasks.size() && fault_.empty())
            check(plan_.channels[step.channel]);
        return true;
    }

    void clear(const RenderContext& c) {
        for (int32_t y = c.viewport.y; y < c.viewport.top(); ++y) {
            for (int32_t x = c.viewport.x; x < c.viewport.right(); ++x) pixelsOf(c)[{x, y}].clear();
        }
    }

    // In an enlarged picture several pixels are drawn for one.
    static int32_t pixelOf(const PixelAxis& axis, int32_t i) {
        const double at = axis.origin + axis.scale * (axis.kernel + i * axis.step);
        return static_cast<int32_t>(axis.scale < 1 ? std::floor(at + 1e-9) : std::round(at));
    }

    void drawInto(Pixels& pixels, const RenderContext& c, int32_t toX, int32_t toY) {
        for (int32_t y = 0; y < c.viewport.h; ++y) {
            for (int32_t x = 0; x < c.viewport.w; ++x)
                pixels[{toX + x, toY + y}].push_back(
                    {pixelOf(c.x, x), pixelOf(c.y, y), c.range, c.subPixel, c.destination, contextOf(c)});
        }
    }

    [[nodiscard]] Index contextOf(const RenderContext& c) const {
        const bool planned = &c >= plan_.contexts.data() && &c < plan_.contexts.data() + plan_.contexts.size();
        return planned ? static_cast<Index>(&c - plan_.contexts.data()) : kNone;
    }

    // Tiles are drawn, transferred and assembled one by one. Here the first channel draws all of them, each in its
    // place.
    void draw(const PlannedTask& task, const RenderContext& c) {
        if (task.queue == kNone) return drawInto(pixelsOf(c), c, c.viewport.x, c.viewport.y);
        const PlannedQueue& queue = plan_.queues[ResolvedConfig::at(task.queue)];
        if (!takenQueues_.insert({task.queue, true}).second) return;
        const RenderContext& divided = plan_.contexts[ResolvedConfig::at(queue.context)];
        for (const PlannedTile& tile : queue.tiles) {
            const RenderContext one = contextOfTile(c, divided, tile);
            drawInto(pixelsOf(c), one, c.viewport.x + tile.area.x - divided.area.x,
                     c.viewport.y + tile.area.y - divided.area.y);
        }
    }

    void readBack(const RenderContext& c, Index f) {
        const PlannedFrame& frame = plan_.frames[ResolvedConfig::at(f)];
        const PixelViewport& area = frame.area;
        auto& picture = frames_[ResolvedConfig::at(f)];
        for (int32_t y = 0; y < area.h; ++y) {
            for (int32_t x = 0; x < area.w; ++x) {
                const Pixel& drawn = pixelsOf(c)[{area.x + x, area.y + y}];
                // An enlarged picture is reduced for the transfer: the mean of the pixels drawn for the same one.
                const auto [at, isFirst] = picture.try_emplace(
                    {static_cast<int32_t>(x * frame.zoom.x + 1e-9), static_cast<int32_t>(y * frame.zoom.y + 1e-9)},
                    drawn);
                if (!isFirst && !(frame.zoom == Zoom{}) && !drawnForSame(at->second, drawn))
                    fault_ = "pixels for several are made one";
                else if (!isFirst)
                    at->second = drawn;
            }
        }
        ready_[ResolvedConfig::at(f)] = true;
    }

    static bool drawnForSame(const Pixel& a, const Pixel& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](const Share& one, const Share& other) { return one.x == other.x && one.y == other.y; });
    }

    // Whole pictures replace the existing content; parts of the range and samples are merged with it. removes: only
    // removes existing content that the picture contains.
    void assemble(const RenderContext& c, const FrameUse& use, bool removes) {
        const PlannedFrame& frame = plan_.frames[ResolvedConfig::at(use.frame)];
        const bool replaces = !frame.buffers.has(config::Buffer::Depth) && frame.range.full() && frame.subPixel.whole();
        for (const auto& [at, pixel] : frames_[ResolvedConfig::at(use.frame)]) {
            if (frame.perTile && pixel.empty()) continue; // another channel has taken that tile
            const int32_t x0 = use.x + use.kernel.x + enlarged(use.kernel.w * at.first, use.zoom.x),
                          y0 = use.y + use.kernel.y + enlarged(use.kernel.h * at.second, use.zoom.y);
            for (int32_t y = y0; y < y0 + enlarged(1, use.zoom.y); ++y)
                for (int32_t x = x0; x < x0 + enlarged(1, use.zoom.x); ++x) {
                    if (x < use.clip.x || y < use.clip.y || x >= use.clip.right() || y >= use.clip.top()) continue;
                    Pixel& to = pixelsOf(c)[{x, y}];
                    if (replaces || removes) to.clear();
                    for (Share s : removes ? Pixel() : pixel) { // one pixel of the picture stands for several
                        s.x += x - x0, s.y += y - y0;
                        to.push_back(s);
                    }
                }
        }
    }

    // Test files use integer zooms only.
    static int32_t enlarged(int32_t pixels, double zoom) { return static_cast<int32_t>(std::lround(pixels * zoom)); }

    // A finished destination must be complete, in each eye that it was drawn for.
    void check(const ChannelPlan& done) {
        const PixelViewport& channel = input_.sizes.channels[ResolvedConfig::at(done.channel)];
        for (const Eye eye : kEyes) {
            const auto drawn = std::find_if(plan_.contexts.begin(), plan_.contexts.end(), [&](const RenderContext& c) {
                return c.channel == done.channel && c.destination == done.channel && c.view != kNone && c.eye == eye;
            });
            if (drawn == plan_.contexts.end()) continue;
            shown[{done.channel, eye}] = pixelsOf(*drawn);
            for (int32_t i = 0; i < channel.w * channel.h && fault_.empty(); ++i) {
                const int32_t x = i % channel.w, y = i / channel.w;
                const std::string wrong = faultOf(pixelsOf(*drawn)[{channel.x + x, channel.y + y}], x, y, done.channel);
                if (!wrong.empty())
                    fault_ = "channel " + config_.channels[ResolvedConfig::at(done.channel)].name + " eye " +
                             nameOf(eye) + " pixel " + std::to_string(x) + " " + std::to_string(y) + ": " + wrong;
            }
        }
    }

    static std::string faultOf(const Pixel& pixel, int32_t x, int32_t y, Index destination) {
        if (pixel.empty()) return "nothing was drawn";
        std::vector<std::pair<double, double>> edges; // of ranges: the weight that starts or ends there
        for (const Share& s : pixel) {
            if (s.destination == destination && (s.x != x || s.y != y))
                return "drawn for pixel " + std::to_string(s.x) + " " + std::to_string(s.y);
            edges.emplace_back(s.range.start, 1. / s.sample.size);
            edges.emplace_back(s.range.end, -1. / s.sample.size);
        }
        std::sort(edges.begin(), edges.end());
        if (std::abs(edges.front().first) > 1e-9 || std::abs(edges.back().first - 1) > 1e-9)
            return "the range is " + std::to_string(edges.front().first) + " to " + std::to_string(edges.back().first);
        double weight = 0; // over all samples, 1 in each part of the range
        for (size_t i = 0; i < edges.size(); ++i) {
            weight += edges[i].second;
            const bool sameEdge = i + 1 < edges.size() && edges[i + 1].first - edges[i].first < 1e-9;
            if (!sameEdge && i + 1 < edges.size() && std::abs(weight - 1) > 1e-9)
                return "from range " + std::to_string(edges[i].first) + " on it is drawn " + std::to_string(weight) +
                       " times";
        }
        return {};
    }

    const ResolvedConfig& config_;
    const FrameInput& input_;
    const FramePlan& plan_;
    std::map<std::pair<Index, Eye>, Pixels> buffers_;
    std::vector<Pixels> frames_;
    std::vector<bool> ready_;
    std::map<Index, bool> takenQueues_;
    std::string fault_;
};

} // namespace mural::compound::testing
