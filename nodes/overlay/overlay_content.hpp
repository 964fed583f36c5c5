// The contents of an overlay, and the place of the picture that it is drawn over.
#pragma once

#include <string>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"
#include "nodes/overlay/frame_parts.hpp"
#include "nodes/overlay/overlay_mode.hpp"

namespace mural {

// The picture of a window, as a part of the wall's picture.
struct OverlayPlace {
    std::string title;  // of the window
    PixelViewport part; // in pixels of the wall, origin lower left
    int wallWidth = 0, wallHeight = 0;
    double wallWidthMm = 0, wallHeightMm = 0; // 0: unknown

    friend bool operator==(const OverlayPlace&, const OverlayPlace&) = default;
};

// The numbers of one node, for `stats`.
struct OverlayNode {
    std::string name;
    FrameHistory frames;
};

struct OverlayContent {
    OverlayMode mode = OverlayMode::Off;
    std::string host;
    std::string role; // "node 2", "head"
    std::vector<OverlayNode> nodes;
};

} // namespace mural
