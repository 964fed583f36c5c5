#include "nodes/head/preview/window_pictures.hpp"

#include <algorithm>

#include "nodes/output/jpeg_picture.hpp"

namespace mural {

namespace {

bool isSound(const wire::PreviewTileHeader& header) {
    const auto isSide = [](uint32_t side) { return side > 0 && side <= wire::kMaxPreviewSide; };
    return isSide(header.pictureWidth) && isSide(header.pictureHeight) && header.wallWidth > 0 &&
           header.wallHeight > 0 && header.wallWidth <= INT32_MAX && header.wallHeight <= INT32_MAX &&
           header.tile < header.tiles && header.tiles <= wire::kMaxPreviewTiles && header.x >= 0 && header.y >= 0 &&
           header.w >= 0 && header.h >= 0 && int64_t{header.x} + header.w <= header.pictureWidth &&
           int64_t{header.y} + header.h <= header.pictureHeight;
}

bool isSameSize(const wire::PreviewTileHeader& a, const wire::PreviewTileHeader& b) {
    return a.pictureWidth == b.pictureWidth && a.pictureHeight == b.pictureHeight;
}

} // namespace

wire::WantPreviewCommand WindowPictures::begin(uint32_t maxWidth, uint32_t maxHeight) {
    const std::lock_guard lock(mutex_);
    const wire::WantPreviewCommand request{++number_, std::min(maxWidth, wire::kMaxPreviewSide),
                                           std::min(maxHeight, wire::kMaxPreviewSide)};
    mostWidth_ = std::max(mostWidth_, request.maxWidth);
    mostHeight_ = std::max(mostHeight_, request.maxHeight);
    return request;
}

Result<void> WindowPictures::add(int node, const wire::PreviewTileHeader& header, std::span<const std::byte> jpeg) {
    if (!isSound(header)) return Error{"it sent a preview with an invalid place"};
    const std::lock_guard lock(mutex_);
    if (header.pictureWidth > mostWidth_ || header.pictureHeight > mostHeight_)
        return Error{"it sent a preview that is larger than requested"};
    Tile& tile = tiles_[{node, header.tile}];
    if (!jpeg.empty() && !pictureOfJpeg(jpeg, header.w, header.h, tile.picture))
        return Error{"it sent a preview that is no picture of its size"};
    tile.header = header;
    // A node that now has fewer tiles no longer shows the others.
    std::erase_if(tiles_,
                  [&](const auto& entry) { return entry.first.first == node && entry.first.second >= header.tiles; });
    if (header.tile + 1 == header.tiles) composeIfComplete(header);
    return {};
}

void WindowPictures::forget(int node) {
    const std::lock_guard lock(mutex_);
    std::erase_if(tiles_, [node](const auto& entry) { return entry.first.first == node; });
}

// Composes when each node that has tiles has replied to the request. A node that is silent delays the picture until the
// next request, whose number its old tiles do not have either; then they are shown as they are.
void WindowPictures::composeIfComplete(const wire::PreviewTileHeader& header) {
    uint32_t frame = 0;
    for (const auto& [key, tile] : tiles_) {
        if (tile.header.number + 1 < header.number || !isSameSize(tile.header, header)) continue; // silent
        if (tile.header.number != header.number) return;                                          // it may reply
        if (tile.header.client == header.client) frame = std::max(frame, tile.header.frame);
    }
    const bool isNewer = header.client != client_ || frame > frame_;
    if (!isNewer && header.pictureWidth <= width_) return;
    auto picture =
        std::make_shared<OwnedPicture>(static_cast<int>(header.pictureWidth), static_cast<int>(header.pictureHeight));
    std::fill_n(picture->data(), picture->view().sizeBytes(), std::byte{0});
    for (const auto& [key, tile] : tiles_)
        if (isSameSize(tile.header, header) && tile.picture.width() > 0)
            copyInto(*picture, tile.header.x, tile.header.y, tile.picture.view());
    if (isNewer) wallFrame_ += header.client == client_ ? frame - frame_ : 1;
    client_ = header.client;
    frame_ = frame;
    width_ = header.pictureWidth;
    onPicture_(
        {std::move(picture), wallFrame_, static_cast<int>(header.wallWidth), static_cast<int>(header.wallHeight)});
}

} // namespace mural
