#include "nodes/output/windows/overlay_layer.hpp"

#include <utility>

#include "nodes/overlay/overlay_picture.hpp"

namespace mural {

Picture OverlayLayer::over(const Picture& picture, OverlayPlace place) {
    if (!overlay_) return picture;
    const uint64_t version = overlay_->version(); // before the content, which may be newer
    mode_ = overlay_->mode();
    if (mode_ == OverlayMode::Off || picture.empty()) return picture;
    place.part.w = picture.width;
    place.part.h = picture.height;
    if (version != version_ || place != place_) {
        const OverlayContent content = overlay_->content();
        mode_ = content.mode;
        image_ = drawOverlay(content, place);
        place_ = std::move(place);
        version_ = version;
    }
    drawn_.assign(picture);
    image_.drawOver(drawn_.data(), picture.format);
    return drawn_.view();
}

} // namespace mural
