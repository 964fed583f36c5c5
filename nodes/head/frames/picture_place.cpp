#include "nodes/head/frames/picture_place.hpp"

#include "common/base/picture_format.hpp"
#include "nodes/frame_transfer/transfer_scale.hpp"

namespace mural {

Result<PlacedPicture> placeOnWall(const NodePlan& node, const wire::PictureHeader& header, ByteBuffer rows) {
    if (node.transferScale.none() && !node.shown) return PlacedPicture{header, std::move(rows)};
    const ScaledSize size = scaledSizeOf(header.w, header.h, node.transferScale);
    const bool sensible = header.format == static_cast<uint32_t>(PictureFormat::Bgra8) &&
                          header.windowWidth <= kMaxPictureSide && header.windowHeight <= kMaxPictureSide &&
                          header.w >= 0 && header.h >= 0 && static_cast<uint32_t>(header.w) <= header.windowWidth &&
                          static_cast<uint32_t>(header.h) <= header.windowHeight && size.bytes() == rows.size();
    if (!sensible) return Error{"it sent a picture of invalid size"};
    PlacedPicture placed;
    placed.header = header;
    if (node.shown && size.bytes() > 0) {
        const PixelViewport window{0, 0, static_cast<int32_t>(header.windowWidth),
                                   static_cast<int32_t>(header.windowHeight)};
        const PixelViewport shown = intersect(apply(window, *node.shown), window);
        placed.header.x = shown.x;
        placed.header.y = shown.y;
        placed.header.w = shown.w;
        placed.header.h = shown.h;
    }
    const ScaledSize onWall{placed.header.w, placed.header.h};
    placed.rows = ByteBuffer::ofSize(onWall.bytes());
    if (placed.rows.size() != onWall.bytes())
        return Error{"no memory for a picture of " + std::to_string(onWall.bytes()) + " bytes"};
    resizePicture(rows.data(), size.w, size.h, placed.rows.data(), onWall.w, onWall.h);
    return placed;
}

} // namespace mural
