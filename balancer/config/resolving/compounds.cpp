// Flattens the compound trees and resolves their channels, frames, queues and barriers.
#include <algorithm>
#include <functional>

#include "balancer/config/resolving/attribute_filler.hpp"
#include "balancer/config/resolving/resolver.hpp"
#include "balancer/config/screen.hpp"

namespace mural::config {

namespace {

std::string shown(const Reference& reference) {
    if (const auto* name = std::get_if<std::string>(&reference)) return "\"" + *name + "\"";
    return "number " + std::to_string(std::get<uint32_t>(reference));
}

// Follows the steps of "( canvas X segment Y layout Z view W )". An omitted step selects the first element.
class PathFollower {
public:
    explicit PathFollower(const Resolver& r)
        : c_(r.out),
          segment_(firstOf(c_.canvases, &ResolvedCanvas::segments)),
          view_(firstOf(c_.layouts, &ResolvedLayout::views)) {}

    // Returns the missing step, or an empty text on success.
    std::string follow(const ChannelPath& path) {
        for (const auto& [step, reference] : path.steps) {
            if (take(step, reference)) continue;
            const bool inCanvas = step == PathStep::Segment && canvas_ != kNone,
                       inLayout = step == PathStep::View && layout_ != kNone;
            return "there is no " + std::string(wordOf(step)) + " " + shown(reference) +
                   (inCanvas   ? " in that canvas"
                    : inLayout ? " in that layout"
                               : "");
        }
        if (segment_ == kNone) return "the canvas has no segment";
        if (view_ == kNone) return "the layout has no view";
        return {};
    }

    [[nodiscard]] Index segment() const { return segment_; }
    [[nodiscard]] Index view() const { return view_; }

private:
    template <class T> static Index firstOf(const std::vector<T>& all, std::vector<Index> T::*members) {
        return all.empty() || (all.front().*members).empty() ? kNone : (all.front().*members).front();
    }

    // Searches the members of the chosen container, or all elements if none is chosen. Numbers then refer to the first
    // container.
    template <class T, class Whole>
    Index find(const Reference& reference, const std::vector<T>& all, const std::vector<Index>* members,
               const std::vector<Whole>& wholes, std::vector<Index> Whole::*of) const {
        if (const auto* name = std::get_if<std::string>(&reference)) {
            if (members == nullptr) return Resolver::named(all, *name);
            const auto found = std::find_if(members->begin(), members->end(),
                                            [&](Index i) { return all[Resolver::at(i)].name == *name; });
            return found == members->end() ? kNone : *found;
        }
        if (members == nullptr && !wholes.empty()) members = &(wholes.front().*of);
        const uint32_t index = std::get<uint32_t>(reference);
        return members != nullptr && index < members->size() ? (*members)[index] : kNone;
    }

    template <class T> static Index findWhole(const Reference& reference, const std::vector<T>& all) {
        if (const auto* name = std::get_if<std::string>(&reference)) return Resolver::named(all, *name);
        const uint32_t index = std::get<uint32_t>(reference);
        return index < all.size() ? static_cast<Index>(index) : kNone;
    }

    bool take(PathStep step, const Reference& reference) {
        if (step == PathStep::Canvas) {
            canvas_ = findWhole(reference, c_.canvases);
            if (canvas_ == kNone) return false;
            const auto& segments = c_.canvases[Resolver::at(canvas_)].segments;
            segment_ = segments.empty() ? kNone : segments.front();
        } else if (step == PathStep::Layout) {
            layout_ = findWhole(reference, c_.layouts);
            if (layout_ == kNone) return false;
            const auto& views = c_.layouts[Resolver::at(layout_)].views;
            view_ = views.empty() ? kNone : views.front();
        } else if (step == PathStep::Segment) {
            segment_ =
                find(reference, c_.segments, canvas_ == kNone ? nullptr : &c_.canvases[Resolver::at(canvas_)].segments,
                     c_.canvases, &ResolvedCanvas::segments);
            return segment_ != kNone;
        } else {
            view_ = find(reference, c_.views, layout_ == kNone ? nullptr : &c_.layouts[Resolver::at(layout_)].views,
                         c_.layouts, &ResolvedLayout::views);
            return view_ != kNone;
        }
        return true;
    }

    const ResolvedConfig& c_;
    Index canvas_ = kNone, layout_ = kNone;
    Index segment_, view_;
};

Index channelOf(Resolver& r, const ChannelReference& reference, SourcePosition at) {
    if (const auto* name = std::get_if<std::string>(&reference)) {
        const Index channel = Resolver::named(r.out.channels, *name);
        if (channel == kNone)
            r.diagnostics.error(at, "unknown channel \"" + *name + "\"",
                                "define it in a window, or choose another one");
        return channel;
    }
    PathFollower way(r);
    if (const std::string missing = way.follow(std::get<ChannelPath>(reference)); !missing.empty()) {
        r.diagnostics.error(at, missing, "check the path of the compound's channel");
        return kNone;
    }
    const Index channel = destinationChannel(r.out, way.segment(), way.view());
    if (channel == kNone) {
        const ResolvedSegment& s = r.out.segments[Resolver::at(way.segment())];
        const ResolvedView& v = r.out.views[Resolver::at(way.view())];
        const std::string& layout = r.out.layouts[Resolver::at(v.layout)].name;
        r.diagnostics.error(at,
                            "segment \"" + s.name + "\" shows none of the selected views of layout \"" + layout + "\"",
                            "add the layout to that canvas, or choose another segment or view");
    }
    return channel;
}

ResolvedFrame frameOf(Resolver& r, const Frame& f) {
    ResolvedFrame frame;
    frame.name = f.name.value_or("");
    frame.type = f.type.value_or(FrameType::Memory);
    frame.viewport = f.viewport.value_or(Viewport{});
    frame.buffers = f.buffers;
    frame.zoom = f.zoom;
    frame.codec = f.codec.value_or("auto");
    frame.exact = f.exact.value_or(value::kOn) != value::kOff;
    frame.at = f.at;
    if (frame.zoom && !frame.zoom->valid()) {
        r.diagnostics.warn(f.at, "a zoom must be above 0, this one is ignored", "use two numbers above 0");
        frame.zoom.reset();
    }
    if (frame.viewport.empty()) {
        r.diagnostics.warn(f.at, "the viewport of this frame is empty, the whole frame is used",
                           "set x, y, width and height as fractions of 1");
        frame.viewport = {};
    }
    return frame;
}

// Invalid values count as omitted.
template <class T, class Good>
void take(Resolver& r, const std::optional<T>& given, T& target, SourcePosition at, const char* what,
          const char* remedy, Good good) {
    if (!given) return;
    if (good(*given))
        target = *given;
    else
        r.diagnostics.warn(at, std::string(what) + ", it is ignored", remedy);
}

void takeParameters(Resolver& r, const Compound& c, ResolvedCompound& to) {
    take(r, c.viewport, to.viewport, c.at, "the viewport of this compound is empty or outside of 0 to 1",
         "set x, y, width and height as fractions of 1", [](const Viewport& v) {
             return v.w >= 0 && v.h >= 0 && v.x >= 0 && v.y >= 0 && v.x + v.w <= 1.001 && v.y + v.h <= 1.001;
         });
    take(r, c.range, to.range, c.at, "the range of this compound is reversed or outside of 0 to 1",
         "set two numbers from 0 to 1",
         [](const Range& v) { return v.start >= 0 && v.end >= v.start && v.end <= 1.001; });
    take(r, c.zoom, to.zoom, c.at, "this zoom is not above 0, or above 1000", "use two numbers above 0",
         [](const Zoom& z) { return z.valid() && z.x <= 1000 && z.y <= 1000; });
    take(r, c.pixel, to.pixel, c.at, "this pixel kernel is invalid",
         "set x, y, width and height with 0 <= x < width, 0 <= y < height",
         [](const PixelKernel& k) { return k.valid() && k.w <= 4096 && k.h <= 4096; });
    take(r, c.subPixel, to.subPixel, c.at, "this subpixel is invalid", "set index and count with 0 <= index < count",
         [](const SubPixel& s) { return s.valid() && s.size <= 65536; });
    if (c.period && *c.period > 0)
        to.period = c.period;
    else if (c.period)
        r.diagnostics.warn(c.at, "a period of 0 frames is invalid, it is ignored", "use 1 or more");
    to.phase = c.phase;
}

Index addCompound(Resolver& r, const Compound& c, Index parent) {
    ResolvedCompound compound;
    compound.parent = parent;
    compound.name = c.name.value_or("");
    compound.tasks = c.tasks;
    compound.eyes = c.eyes;
    compound.buffers = c.buffers;
    compound.composition =
        c.composition.value_or(parent == kNone ? std::string() : r.out.compounds[Resolver::at(parent)].composition);
    compound.surface = c.surface;
    compound.attributes = c.attributes;
    compound.equalizers = c.equalizers;
    compound.at = c.at;
    takeParameters(r, c, compound);
    if (c.surface && !screenOf(*c.surface).usable())
        r.diagnostics.error(c.at, "the wall or projection of this compound has no area",
                            "set a rectangle, or distance and angles above 0");
    if (c.channel) compound.channel = channelOf(r, *c.channel, c.at);
    for (const Frame& f : c.outputFrames) compound.outputFrames.push_back(frameOf(r, f));
    for (const Frame& f : c.inputFrames) compound.inputFrames.push_back(frameOf(r, f));
    for (const TileQueue& q : c.outputTiles) compound.outputQueues.push_back({q.name.value_or(""), q.size, q.at});
    for (const TileQueue& q : c.inputTiles) compound.inputQueues.push_back({q.name.value_or(""), q.size, q.at});
    if (c.swapBarrier)
        compound.barrier =
            ResolvedBarrier{c.swapBarrier->name.value_or(""), c.swapBarrier->nvGroup, c.swapBarrier->nvBarrier};
    const Index index = Resolver::add(r.out.compounds, compound);
    if (parent != kNone)
        r.out.compounds[Resolver::at(parent)].children.push_back(index);
    else
        r.out.roots.push_back(index);
    for (const Compound& child : c.children) addCompound(r, child, index);
    return index;
}

// Returns "frame.left": named after the compound, otherwise after its channel, otherwise after the parent.
std::string defaultName(const ResolvedConfig& c, Index compound, const std::string& kind) {
    for (Index i = compound; i != kNone; i = c.compounds[Resolver::at(i)].parent) {
        const ResolvedCompound& one = c.compounds[Resolver::at(i)];
        if (!one.name.empty()) return kind + "." + one.name;
        if (one.executing != kNone && !c.channels[Resolver::at(one.executing)].name.empty())
            return kind + "." + c.channels[Resolver::at(one.executing)].name;
    }
    return kind;
}

} // namespace

void resolveCompounds(Resolver& r) {
    for (const Compound& c : r.file.config.compounds) addCompound(r, c, kNone);
}

void linkChannels(ResolvedConfig& config) {
    const std::function<void(Index)> visit = [&](Index index) {
        ResolvedCompound& c = config.compounds[Resolver::at(index)];
        const ResolvedCompound* parent = c.parent == kNone ? nullptr : &config.compounds[Resolver::at(c.parent)];
        c.executing = c.channel != kNone || parent == nullptr ? c.channel : parent->executing;
        c.destination = parent != nullptr && parent->destination != kNone ? parent->destination : c.channel;
        for (const Index child : c.children) visit(child);
    };
    for (const Index root : config.roots) visit(root);
}

void nameFrames(Resolver& r) {
    ResolvedConfig& config = r.out;
    const std::function<void(Index, const std::string&)> visit = [&](Index index, const std::string& rootName) {
        ResolvedCompound& c = config.compounds[Resolver::at(index)];
        for (auto* frames : {&c.outputFrames, &c.inputFrames}) {
            for (ResolvedFrame& f : *frames) {
                if (f.name.empty()) f.name = defaultName(config, index, "frame");
            }
        }
        for (auto* queues : {&c.outputQueues, &c.inputQueues}) {
            for (ResolvedQueue& q : *queues) {
                if (q.name.empty()) q.name = defaultName(config, index, "queue");
            }
        }
        if (c.barrier && c.barrier->name.empty())
            c.barrier->name = rootName.empty() ? "barrier" : "barrier." + rootName;
        // The compound that shows a segment joins the segment's swap barrier.
        const bool shows = c.channel != kNone && c.channel == c.destination &&
                           config.channels[Resolver::at(c.channel)].isDestination();
        if (!c.barrier && shows &&
            (c.parent == kNone || config.compounds[Resolver::at(c.parent)].destination == kNone)) {
            c.barrier = config.segments[Resolver::at(config.channels[Resolver::at(c.channel)].segment)].barrier;
        }
        for (const Index child : c.children) visit(child, rootName);
    };
    for (const Index root : config.roots) {
        fillAttributes(config.compounds[Resolver::at(root)].attributes, "COMPOUND", r.defaults);
        visit(root, config.compounds[Resolver::at(root)].name);
    }
}

} // namespace mural::config
