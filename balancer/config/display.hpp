// The model of displays: canvases with segments, layouts with views, observers.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "balancer/config/attribute_values.hpp"
#include "balancer/config/projection_surface.hpp"
#include "common/geometry/eye.hpp"
#include "common/geometry/viewport.hpp"

namespace mural::config {

// A reference to another object of the file, by name or by its definition index, from 0.
using Reference = std::variant<std::string, uint32_t>;
// monostate: OFF, the canvas is dark.
using LayoutReference = std::variant<std::monostate, std::string, uint32_t>;

enum class FocusMode : uint8_t { Fixed, RelativeToOrigin, RelativeToObserver };

struct Observer {
    std::optional<std::string> name;
    std::optional<double> eyeBase; // in metres
    std::optional<Vector3> eyeLeft, eyeCyclop, eyeRight;
    std::optional<double> focusDistance;
    std::optional<FocusMode> focusMode;
    Attribute opencvCamera;
    std::optional<std::string> vrpnTracker;
    SourcePosition at;
    friend bool operator==(const Observer&, const Observer&) = default;
};

enum class ViewMode : uint8_t { Mono, Stereo };

struct View {
    std::optional<std::string> name;
    std::optional<ViewMode> mode;
    std::optional<Viewport> viewport;
    std::optional<ProjectionSurface> surface;
    std::optional<Reference> observer;
    std::optional<std::string> deflectHost;
    SourcePosition at;
    friend bool operator==(const View&, const View&) = default;
};

struct Layout {
    std::optional<std::string> name;
    std::vector<View> views;
    SourcePosition at;
    friend bool operator==(const Layout&, const Layout&) = default;
};

struct SwapBarrier {
    std::optional<std::string> name;
    Attribute nvGroup, nvBarrier;
    SourcePosition at;
    friend bool operator==(const SwapBarrier&, const SwapBarrier&) = default;
};

// Width of a monitor's frame, in millimetres.
struct Bezel {
    double left = 0;
    double right = 0;
    double bottom = 0;
    double top = 0;
    friend constexpr bool operator==(const Bezel&, const Bezel&) = default;
};

struct Segment {
    std::optional<std::string> name;
    std::optional<std::string> channel;
    std::vector<std::string> copies; // other channels with the same picture
    std::optional<EyeSet> eyes;
    std::optional<Viewport> viewport;
    std::optional<Bezel> bezel;
    std::optional<ProjectionSurface> surface;
    std::optional<SwapBarrier> swapBarrier;
    SourcePosition at;
    friend bool operator==(const Segment&, const Segment&) = default;
};

struct Canvas {
    std::optional<std::string> name;
    std::vector<LayoutReference> layouts;
    std::optional<ProjectionSurface> surface;
    std::optional<Bezel> bezel; // default of all segments
    std::optional<SwapBarrier> swapBarrier;
    std::vector<Segment> segments;
    SourcePosition at;
    friend bool operator==(const Canvas&, const Canvas&) = default;
};

} // namespace mural::config
