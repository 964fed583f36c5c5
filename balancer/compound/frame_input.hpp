// What a frame's tasks depend on besides the configuration: which layouts are shown, the state of views, where
// observers are, and what equalizers have changed. What is not given has its default.
#pragma once

#include "balancer/compound/display_sizes.hpp"
#include "common/matrix4.hpp"

namespace mural::compound {

// Pixels that are drawn around a view, for effects that look at neighbours.
struct Overdraw {
    int32_t left = 0, bottom = 0, right = 0, top = 0;
};

struct ViewState {
    std::optional<config::ViewMode> mode; // otherwise the file's
    double modelUnit = 1;                 // units of the program in a metre
    Overdraw overdraw;
};

struct ObserverState {
    Matrix4 head; // from the head into the room
};

// What equalizers change in a compound, from frame to frame.
struct CompoundState {
    std::optional<Viewport> viewport;
    std::optional<Range> range;
    std::optional<Zoom> zoom;
    bool active = true; // no: with all that is below
};

struct FrameInput {
    uint64_t frameNumber = 0;
    DisplaySizes sizes;
    std::vector<Index> activeLayouts; // of each canvas: which of its layouts, 0 is the first; kNone: nothing
    std::vector<ViewState> views;
    std::vector<ObserverState> observers;
    std::vector<CompoundState> compounds;
    double nearPlane = .1;
    double farPlane = 100;
};

} // namespace mural::compound
