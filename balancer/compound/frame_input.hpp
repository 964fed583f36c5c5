// Inputs of a frame's plan besides the configuration: active layouts, view state, observer positions, and changes by
// equalizers. Missing values have their defaults.
#pragma once

#include "balancer/compound/display_sizes.hpp"
#include "common/geometry/matrix4.hpp"

namespace mural::compound {

// Pixels drawn around a view for effects that read neighbouring pixels.
struct Overdraw {
    int32_t left = 0, bottom = 0, right = 0, top = 0;
};

struct ViewState {
    std::optional<config::ViewMode> mode; // empty: the mode of the file
    double modelUnit = 1;                 // program units per metre
    Overdraw overdraw;
};

struct ObserverState {
    Matrix4 head; // transform from head to room
};

// Place of an input frame of another destination, in pixels of the channel that shows it.
struct InputPlacement {
    int32_t x = 0;
    int32_t y = 0;
    Zoom zoom; // shown pixels per pixel of the producer's area
    friend bool operator==(const InputPlacement&, const InputPlacement&) = default;
};

// Attributes of a compound that equalizers change from frame to frame.
struct CompoundState {
    std::optional<Viewport> viewport;
    std::optional<Range> range;
    std::optional<Zoom> zoom;
    bool active = true;      // false: inactive together with its whole subtree
    bool isAvailable = true; // false: the render node of a leaf is lost; equalizers give it no work
    double usage = 1; // resources of its channels that it may use: 1 is all; equalizers above set it for those below
    std::vector<std::optional<InputPlacement>> inputs; // per input frame; missing ones fill the channel
    double maxFps = 0; // highest rate at which its channels begin frames, in Hz; 0: no limit
    friend bool operator==(const CompoundState&, const CompoundState&) = default;
};

struct FrameInput {
    uint64_t frameNumber = 0;
    DisplaySizes sizes;
    std::vector<Index> activeLayouts; // active layout of each canvas, from 0; kNone: canvas off
    std::vector<ViewState> views;
    std::vector<ObserverState> observers;
    std::vector<CompoundState> compounds;
    double nearPlane = .1;
    double farPlane = 100;
};

} // namespace mural::compound
