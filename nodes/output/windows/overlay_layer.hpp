// The overlay over the pictures of one window. Keeps its pixels until the contents or the window's place change. Used
// by one thread.
#pragma once

#include <cstdint>
#include <memory>

#include "nodes/output/picture.hpp"
#include "nodes/overlay/overlay.hpp"
#include "nodes/overlay/overlay_image.hpp"

namespace mural {

class OverlayLayer {
public:
    // overlay: null: none.
    explicit OverlayLayer(std::shared_ptr<const Overlay> overlay) : overlay_(std::move(overlay)) {}

    // Returns the picture itself, or a copy with the overlay, which is valid until the next call. The size of the
    // picture replaces that of place.part.
    Picture over(const Picture& picture, OverlayPlace place);

    // Returns whether the overlay has changed since the last call of over(): the shown picture must be drawn again.
    [[nodiscard]] bool isOutdated() const {
        return overlay_ &&
               (overlay_->mode() != mode_ || (mode_ != OverlayMode::Off && overlay_->version() != version_));
    }

private:
    const std::shared_ptr<const Overlay> overlay_;
    OverlayMode mode_ = OverlayMode::Off; // of the last picture
    uint64_t version_ = 0;                // of image_; 0: none
    OverlayPlace place_;
    OverlayImage image_;
    OwnedPicture drawn_;
};

} // namespace mural
