// The text of overlays, in DejaVu Sans Bold. The font is a part of the binary, so no machine of the wall needs it.
#pragma once

#include <string_view>

#include "nodes/overlay/overlay_image.hpp"

namespace mural {

// Size of a line of text in pixels: from the top of capitals and brackets to the lowest part of letters.
[[nodiscard]] double overlayTextWidth(std::string_view text, double height);

// Draws a line of UTF-8 with its lower left corner at (x, y). Characters without a glyph become boxes.
void drawOverlayText(OverlayImage& image, std::string_view text, double x, double y, double height,
                     OverlayColour colour);

} // namespace mural
