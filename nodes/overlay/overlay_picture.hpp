// The pixels of an overlay over one window. Pure.
#pragma once

#include "nodes/overlay/overlay_content.hpp"
#include "nodes/overlay/overlay_image.hpp"

namespace mural {

// Returns an image of the size of place.part.
[[nodiscard]] OverlayImage drawOverlay(const OverlayContent& content, const OverlayPlace& place);

// The three modes, over an image of the size of place.part.
void drawNames(OverlayImage& image, const OverlayContent& content, const OverlayPlace& place);
void drawGrid(OverlayImage& image, const OverlayPlace& place);
void drawStats(OverlayImage& image, const OverlayContent& content);

} // namespace mural
