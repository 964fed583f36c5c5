// Resolves observers, layouts, views, canvases and segments, and creates destination channels where views meet
// segments.
#include <algorithm>

#include "balancer/config/resolving/attribute_filler.hpp"
#include "balancer/config/resolving/resolver.hpp"
#include "balancer/config/screen.hpp"

namespace mural::config {

namespace {

std::string shownReference(const Reference& reference) {
    if (const auto* name = std::get_if<std::string>(&reference)) return "\"" + *name + "\"";
    return "number " + std::to_string(std::get<uint32_t>(reference));
}

template <class T> Index find(const std::vector<T>& all, const Reference& reference) {
    if (const auto* name = std::get_if<std::string>(&reference)) return Resolver::named(all, *name);
    const uint32_t index = std::get<uint32_t>(reference);
    return index < all.size() ? static_cast<Index>(index) : kNone;
}

Viewport areaOf(Resolver& r, const std::optional<Viewport>& given, SourcePosition at, const char* of) {
    if (!given) return {};
    if (given->w > 0 && given->h > 0 && given->w <= 1e6 && given->h <= 1e6) return *given;
    r.diagnostics.warn(at, std::string("the viewport of this ") + of + " is empty, the whole area is used",
                       "set x, y, width and height as fractions of 1");
    return {};
}

void checkSurface(Resolver& r, const ProjectionSurface& surface) {
    if (screenOf(surface).usable()) return;
    if (const auto* wall = std::get_if<Wall>(&surface))
        r.diagnostics.error(wall->at, "this wall is not a rectangle", "set three corners of a rectangle with an area");
    else
        r.diagnostics.error(std::get<Projection>(surface).at, "this projection has no area",
                            "set a distance above 0 and angles between 0 and 180 degrees");
}

void addObservers(Resolver& r) {
    for (const Observer& o : r.file.config.observers) {
        const double half = o.eyeBase.value_or(r.out.eyeBase) / 2;
        ResolvedObserver observer;
        observer.name = o.name.value_or("");
        observer.eyeLeft = o.eyeLeft.value_or(Vector3{-half, 0, 0});
        observer.eyeCyclop = o.eyeCyclop.value_or(Vector3{});
        observer.eyeRight = o.eyeRight.value_or(Vector3{half, 0, 0});
        observer.focusDistance = o.focusDistance.value_or(1);
        observer.focusMode = o.focusMode.value_or(FocusMode::Fixed);
        observer.opencvCamera = o.opencvCamera.value_or(value::kOff);
        observer.vrpnTracker = o.vrpnTracker.value_or("");
        observer.at = o.at;
        if (!(observer.focusDistance > 0))
            r.diagnostics.error(o.at, "invalid focus distance: " + std::to_string(observer.focusDistance) + " m",
                                "set a distance above 0");
        r.out.observers.push_back(observer);
    }
}

void addViews(Resolver& r, Index layout, const std::vector<View>& views) {
    for (View v : views) {
        ViewAttributes<View> attributes{v};
        fillAttributes(attributes, "VIEW", r.defaults);
        ResolvedView view;
        view.layout = layout;
        view.name = v.name.value_or("");
        view.mode = v.mode.value_or(ViewMode::Mono);
        view.viewport = areaOf(r, v.viewport, v.at, "view");
        view.surface = v.surface;
        view.deflectHost = v.deflectHost.value_or("");
        view.at = v.at;
        if (v.surface) checkSurface(r, *v.surface);
        if (v.observer) {
            view.observer = find(r.out.observers, *v.observer);
            if (view.observer == kNone)
                r.diagnostics.error(v.at, "unknown observer " + shownReference(*v.observer),
                                    "define it, or choose another one");
        }
        r.out.layouts[Resolver::at(layout)].views.push_back(Resolver::add(r.out.views, view));
    }
}

ResolvedBarrier barrierOf(const SwapBarrier& barrier, const std::string& defaultName) {
    return {barrier.name.value_or(defaultName), barrier.nvGroup, barrier.nvBarrier};
}

// Reduces a segment to the part within its monitor's frame. The size of its surface converts millimetres to fractions.
void cutBezel(Resolver& r, ResolvedSegment& s, const Bezel& bezel, bool ownSurface) {
    const Screen screen = screenOf(s.surface);
    const double widthMm = screen.width * (ownSurface ? 1 : s.outer.w) * 1000,
                 heightMm = screen.height * (ownSurface ? 1 : s.outer.h) * 1000;
    const Viewport seen{bezel.left / widthMm, bezel.bottom / heightMm, 1 - (bezel.left + bezel.right) / widthMm,
                        1 - (bezel.bottom + bezel.top) / heightMm};
    if (std::min({bezel.left, bezel.right, bezel.bottom, bezel.top}) < 0 || seen.empty()) {
        return r.diagnostics.error(s.at, "bezels cover the whole segment, or are negative",
                                   "set millimetres of left, right, bottom and top");
    }
    s.viewport = compose(s.outer, seen);
    s.surfacePart = ownSurface ? seen : s.viewport;
}

Index namedChannel(Resolver& r, const std::string& name, SourcePosition at) {
    const Index channel = Resolver::named(r.out.channels, name);
    if (channel == kNone)
        r.diagnostics.error(at, "unknown channel \"" + name + "\"", "define it in a window, or choose another one");
    return channel;
}

void addSegment(Resolver& r, Index canvas, const Canvas& c, const Segment& s) {
    ResolvedSegment segment;
    segment.canvas = canvas;
    segment.name = s.name.value_or("");
    segment.eyes = s.eyes.value_or(kAllEyes);
    segment.outer = segment.viewport = areaOf(r, s.viewport, s.at, "segment");
    segment.surface = s.surface ? *s.surface : r.out.canvases[Resolver::at(canvas)].surface;
    segment.surfacePart = s.surface ? Viewport{} : segment.viewport;
    segment.at = s.at;
    if (s.surface) checkSurface(r, *s.surface);
    if (const auto& bezel = s.bezel ? s.bezel : c.bezel; bezel && r.diagnostics.errors() == 0)
        cutBezel(r, segment, *bezel, s.surface.has_value());
    if (s.channel)
        segment.channel = namedChannel(r, *s.channel, s.at);
    else
        r.diagnostics.warn(s.at, "this segment has no channel and shows nothing", "set the name of a channel");
    for (const std::string& copy : s.copies) segment.copies.push_back(namedChannel(r, copy, s.at));
    const std::string own =
        segment.name.empty() ? std::to_string(r.out.canvases[Resolver::at(canvas)].segments.size()) : segment.name;
    const std::string whole = c.name && !c.name->empty() ? *c.name : std::to_string(canvas);
    if (s.swapBarrier)
        segment.barrier = barrierOf(*s.swapBarrier, "barrier.segment." + own);
    else if (c.swapBarrier)
        segment.barrier = barrierOf(*c.swapBarrier, "barrier.canvas." + whole);
    r.out.canvases[Resolver::at(canvas)].segments.push_back(Resolver::add(r.out.segments, segment));
}

void addCanvas(Resolver& r, const Canvas& c) {
    ResolvedCanvas canvas;
    canvas.name = c.name.value_or("");
    canvas.surface = c.surface.value_or(Wall{});
    canvas.at = c.at;
    if (c.surface) checkSurface(r, *c.surface);
    for (const LayoutReference& l : c.layouts) {
        Index layout = kNone;
        if (!std::holds_alternative<std::monostate>(l)) {
            const Reference reference = std::holds_alternative<std::string>(l) ? Reference(std::get<std::string>(l))
                                                                               : Reference(std::get<uint32_t>(l));
            layout = find(r.out.layouts, reference);
            if (layout == kNone) {
                r.diagnostics.error(c.at, "unknown layout " + shownReference(reference),
                                    "define it, or choose another one");
                continue;
            }
        }
        canvas.layouts.push_back(layout);
    }
    if (c.layouts.empty())
        r.diagnostics.warn(c.at, "this canvas has no layout and shows nothing", "set the name of a layout");
    const Index index = Resolver::add(r.out.canvases, canvas);
    for (const Segment& s : c.segments) addSegment(r, index, c, s);
    addDestinationChannels(r, index);
}

// Returns the part of a channel that shows `area` of its segment.
Viewport partOfChannel(const Viewport& channel, const Viewport& area) {
    if (!inPixels(channel)) return compose(channel, area);
    const PixelViewport whole{static_cast<int32_t>(channel.x), static_cast<int32_t>(channel.y),
                              static_cast<int32_t>(channel.w), static_cast<int32_t>(channel.h)};
    const PixelViewport part = apply(whole, area);
    return {double(part.x), double(part.y), double(part.w), double(part.h)};
}

} // namespace

Index destinationChannel(const ResolvedConfig& config, Index segment, Index view) {
    for (size_t i = 0; i < config.channels.size(); ++i) {
        if (config.channels[i].segment == segment && config.channels[i].view == view) return static_cast<Index>(i);
    }
    return kNone;
}

void addDestinationChannels(Resolver& r, Index canvas) {
    const std::vector<Index> layouts = r.out.canvases[Resolver::at(canvas)].layouts;
    for (const Index layout : layouts) {
        if (layout == kNone) continue;
        for (const Index v : r.out.layouts[Resolver::at(layout)].views) {
            for (const Index s : r.out.canvases[Resolver::at(canvas)].segments) {
                const ResolvedSegment& segment = r.out.segments[Resolver::at(s)];
                if (segment.channel == kNone || destinationChannel(r.out, s, v) != kNone) continue;
                const Viewport seen = intersect(segment.viewport, r.out.views[Resolver::at(v)].viewport);
                if (seen.empty()) continue;
                ResolvedChannel channel = r.out.channels[Resolver::at(segment.channel)];
                channel.viewport = partOfChannel(channel.viewport, relativeTo(seen, segment.viewport));
                channel.segment = s;
                channel.view = v;
                if (channel.viewport.empty()) continue; // less than a pixel
                r.out.windows[Resolver::at(channel.window)].channels.push_back(Resolver::add(r.out.channels, channel));
            }
        }
    }
}

void resolveDisplays(Resolver& r) {
    addObservers(r);
    for (const Layout& l : r.file.config.layouts) {
        ResolvedLayout layout;
        layout.name = l.name.value_or("");
        layout.at = l.at;
        addViews(r, Resolver::add(r.out.layouts, layout), l.views);
    }
    for (const Canvas& c : r.file.config.canvases) addCanvas(r, c);
}

void addDefaultObserver(Resolver& r) {
    if (!r.out.observers.empty()) return;
    const double half = r.out.eyeBase / 2;
    ResolvedObserver observer;
    observer.eyeLeft.x = -half;
    observer.eyeRight.x = half;
    r.out.observers.push_back(observer);
    for (ResolvedView& v : r.out.views) v.observer = 0;
}

} // namespace mural::config
