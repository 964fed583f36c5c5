// Adds implied objects: compounds for channels without one, canvases for channels without one, queues of tile
// equalizers, copies of segments.
#include <algorithm>
#include <functional>

#include "balancer/config/resolving/resolver.hpp"

namespace mural::config {

namespace {

Index addGenerated(ResolvedConfig& config, Index parent, const std::string& name, Index channel, SourcePosition at) {
    ResolvedCompound c;
    c.parent = parent;
    c.name = name;
    c.channel = channel;
    c.isGenerated = true;
    c.at = at;
    const Index index = Resolver::add(config.compounds, c);
    if (parent != kNone) config.compounds[Resolver::at(parent)].children.push_back(index);
    return index;
}

std::vector<Index> compoundsInOrder(const ResolvedConfig& config, Index root) {
    std::vector<Index> all;
    const std::function<void(Index)> visit = [&](Index i) {
        all.push_back(i);
        for (const Index child : config.compounds[Resolver::at(i)].children) visit(child);
    };
    visit(root);
    return all;
}

// Returns true for a compound without tasks, such as one that only holds a swap barrier.
bool isIdle(const ResolvedConfig& config, Index compound) {
    const ResolvedCompound& c = config.compounds[Resolver::at(compound)];
    const bool below =
        std::all_of(c.children.begin(), c.children.end(), [&](Index child) { return isIdle(config, child); });
    return c.tasks && c.tasks->empty() && below;
}

// Returns true if one of the first `segments` segments shows the channel.
bool isShown(const ResolvedConfig& config, Index channel, size_t segments) {
    return config.channels[Resolver::at(channel)].isDestination() ||
           std::any_of(config.segments.begin(), config.segments.begin() + static_cast<std::ptrdiff_t>(segments),
                       [&](const ResolvedSegment& s) { return s.channel == channel; });
}

// Returns true for the first compound with a channel on the path from the root.
bool isDestination(const ResolvedConfig& config, const ResolvedCompound& c) {
    return c.channel != kNone && (c.parent == kNone || config.compounds[Resolver::at(c.parent)].destination == kNone);
}

} // namespace

// A compound for a named channel of a window refers to the destination channel there, if it is unique, or to that of
// the first layout.
void useShownChannels(Resolver& r) {
    ResolvedConfig& config = r.out;
    for (size_t i = 0; i < config.compounds.size(); ++i) {
        ResolvedCompound& c = config.compounds[i];
        if (!isDestination(config, c) || config.channels[Resolver::at(c.channel)].isDestination() ||
            isIdle(config, static_cast<Index>(i)))
            continue;
        for (size_t channel = 0; channel < config.channels.size(); ++channel) {
            const ResolvedChannel& shown = config.channels[channel];
            if (!shown.isDestination() || config.segments[Resolver::at(shown.segment)].channel != c.channel) continue;
            const bool used =
                std::any_of(config.compounds.begin(), config.compounds.end(), [&](const ResolvedCompound& other) {
                    return other.channel == static_cast<Index>(channel);
                });
            if (used) continue;
            c.channel = static_cast<Index>(channel);
            break;
        }
    }
    linkChannels(config);
    // In descendants the same name refers to the picture in progress, if it fills the channel: their drawing is part of
    // it.
    for (ResolvedCompound& c : config.compounds) {
        if (c.channel == kNone || c.channel == c.destination ||
            config.channels[Resolver::at(c.channel)].isDestination())
            continue;
        const ResolvedChannel& shown = config.channels[Resolver::at(c.destination)];
        if (!shown.isDestination() || config.segments[Resolver::at(shown.segment)].channel != c.channel) continue;
        if (shown.viewport == config.channels[Resolver::at(c.channel)].viewport) c.channel = c.destination;
    }
    linkChannels(config);
}

void addOutputCompounds(Resolver& r) {
    ResolvedConfig& config = r.out;
    std::vector<bool> used(config.channels.size(), false);
    for (const ResolvedCompound& c : config.compounds) {
        if (c.channel != kNone) used[Resolver::at(c.channel)] = true;
    }
    for (size_t layout = 0; layout < config.layouts.size(); ++layout) {
        Index group = kNone;
        for (size_t channel = 0; channel < used.size(); ++channel) {
            const ResolvedChannel& one = config.channels[channel];
            if (used[channel] || !one.isDestination() ||
                config.views[Resolver::at(one.view)].layout != static_cast<Index>(layout))
                continue;
            if (group == kNone) {
                group = addGenerated(config, kNone, config.layouts[layout].name, kNone, config.layouts[layout].at);
                config.roots.push_back(group);
            }
            addGenerated(config, group, "", static_cast<Index>(channel), config.layouts[layout].at);
        }
    }
}

// Files from before canvases existed: their destination compounds define the display.
void addDestinationViews(Resolver& r) {
    ResolvedConfig& config = r.out;
    const size_t written = config.segments.size();
    for (const Index root : std::vector<Index>(config.roots)) {
        Index canvas = kNone, view = kNone;
        for (const Index i : compoundsInOrder(config, root)) {
            ResolvedCompound& c = config.compounds[Resolver::at(i)];
            if (!isDestination(config, c) || isShown(config, c.channel, written) || isIdle(config, i)) continue;
            if (canvas == kNone) {
                const ResolvedCompound& top = config.compounds[Resolver::at(root)];
                ResolvedLayout layout;
                layout.name = top.name;
                layout.at = top.at;
                const Index l = Resolver::add(config.layouts, layout);
                ResolvedView v;
                v.layout = l;
                v.at = top.at;
                view = Resolver::add(config.views, v);
                config.layouts[Resolver::at(l)].views = {view};
                ResolvedCanvas surface;
                surface.name = top.name;
                surface.layouts = {l};
                surface.at = top.at;
                surface.surface = top.surface.value_or(Wall{});
                canvas = Resolver::add(config.canvases, surface);
            }
            ResolvedSegment s;
            s.canvas = canvas;
            s.name = c.name;
            s.channel = c.channel;
            s.outer = s.viewport = c.viewport;
            s.surface = c.surface ? *c.surface : config.canvases[Resolver::at(canvas)].surface;
            s.surfacePart = c.surface ? Viewport{} : c.viewport;
            s.at = c.at;
            c.viewport = {};
            c.surface.reset();
            const Index segment = Resolver::add(config.segments, s);
            config.canvases[Resolver::at(canvas)].segments.push_back(segment);
            addDestinationChannels(r, canvas);
            const Index channel = destinationChannel(config, segment, view);
            if (channel != kNone) config.compounds[Resolver::at(i)].channel = channel;
        }
        if (canvas != kNone) config.compounds[Resolver::at(root)].surface.reset();
        linkChannels(config);
    }
}

// A tile equalizer inserts a queue between its compound and every descendant that draws for it.
void addTileQueues(Resolver& r) {
    ResolvedConfig& config = r.out;
    for (size_t i = 0; i < config.compounds.size(); ++i) {
        for (const Equalizer& e : std::vector<Equalizer>(config.compounds[i].equalizers)) {
            const auto* tiles = std::get_if<TileEqualizer>(&e);
            if (tiles == nullptr) continue;
            const std::string name = "queue." + tiles->name.value_or("TileEqualizer") + "." + std::to_string(i);
            PixelsOrRange size = tiles->size;
            if (!size.pixels && !size.range) size.pixels = Pixels2{64, 64};
            config.compounds[i].outputQueues.push_back({name, size, tiles->at});
            for (const Index below : compoundsInOrder(config, static_cast<Index>(i))) {
                ResolvedCompound& c = config.compounds[Resolver::at(below)];
                if (c.isLeaf() && below != static_cast<Index>(i) && c.inputQueues.empty())
                    c.inputQueues.push_back({name, {}, tiles->at});
            }
        }
    }
}

// Copies of a segment: the destination outputs its picture, and each copy inputs it.
void addCopies(Resolver& r) {
    ResolvedConfig& config = r.out;
    for (Index& root : config.roots) {
        for (const Index i : compoundsInOrder(config, root)) {
            const ResolvedCompound& c = config.compounds[Resolver::at(i)];
            if (!isDestination(config, c) || !config.channels[Resolver::at(c.channel)].isDestination()) continue;
            const ResolvedSegment& segment =
                config.segments[Resolver::at(config.channels[Resolver::at(c.channel)].segment)];
            const std::vector<Index> copies = segment.copies;
            const SourcePosition at = segment.at;
            if (copies.empty()) continue;
            ResolvedFrame frame;
            frame.name = "mural.copy." + std::to_string(i);
            frame.at = at;
            config.compounds[Resolver::at(i)].outputFrames.push_back(frame);
            Index group = config.compounds[Resolver::at(i)].parent;
            if (group == kNone) {
                group = addGenerated(config, kNone, config.compounds[Resolver::at(i)].name, kNone, at);
                config.compounds[Resolver::at(group)].attributes = config.compounds[Resolver::at(i)].attributes;
                config.compounds[Resolver::at(group)].children.push_back(i);
                config.compounds[Resolver::at(i)].parent = group;
                root = group;
            }
            for (const Index copy : copies) {
                const Index shown = addGenerated(config, group, "", copy, at);
                config.compounds[Resolver::at(shown)].tasks = TaskSet{Task::Clear, Task::Assemble};
                config.compounds[Resolver::at(shown)].eyes = kAllEyes; // the eyes of the shown picture
                config.compounds[Resolver::at(shown)].inputFrames.push_back(frame);
            }
        }
    }
    linkChannels(config);
}

} // namespace mural::config
