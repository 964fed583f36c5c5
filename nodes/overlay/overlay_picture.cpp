#include "nodes/overlay/overlay_picture.hpp"

namespace mural {

OverlayImage drawOverlay(const OverlayContent& content, const OverlayPlace& place) {
    OverlayImage image(place.part.w, place.part.h);
    if (place.part.empty()) return image;
    switch (content.mode) {
    case OverlayMode::Off: break;
    case OverlayMode::Stats: drawStats(image, content); break;
    case OverlayMode::Names: drawNames(image, content, place); break;
    case OverlayMode::Grid: drawGrid(image, place); break;
    }
    return image;
}

} // namespace mural
