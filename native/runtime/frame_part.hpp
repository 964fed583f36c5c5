// The part of a frame that this node draws, in pixels. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include <mural/render.hpp>

#include "nodes/player/player_setup.hpp"
#include "nodes/session/viewport_assignment.hpp"

namespace mural::native {

struct FramePart {
    RenderPass pass;          // of this frame, with the zoom of its areas
    PixelViewport shown;      // this node's pixels of the picture that it outputs; empty: it outputs none
    PixelViewport picture;    // that whole picture
    PixelViewport drawn;      // this node's pixels of the drawn picture; empty: it draws nothing
    PixelViewport drawnWhole; // the whole drawn picture
    PixelViewport scissor;    // contains `drawn`; larger if the driver requires whole bins (raster_bins.hpp)
    PixelViewport surface;    // the required framebuffer
    uint32_t areas = 0;       // number of the areas
    RenderContext context;
};

// areas: the current ones, if PlayerConfig::areas is set. frame: number of the frame, which determines its turn.
// samples: of the framebuffer.
[[nodiscard]] FramePart framePartOf(const PlayerConfig& config, const ViewportAssignment* areas, const Range& share,
                                    int32_t width, int32_t height, uint32_t frame, int samples);

} // namespace mural::native
