#include "nodes/remote_wall/tile_encoder.hpp"

#include <algorithm>

#include "nodes/frame_transfer/bgra_swizzle.hpp"

namespace mural::remote {

using compositor::PlaneFormat;
using compositor::PlaneView;

Result<FrameEnd> TileEncoder::encode(uint64_t frame, std::span<const Picture> eyes, const OnTile& onTile) {
    const PictureSize size{eyes.front().width, eyes.front().height, static_cast<int>(eyes.size())};
    if (size != size_) hashes_.clear();
    size_ = size;
    FrameEnd end{frame, size, 0, hashes_.empty(), 0};
    const int columns = (size.width + tile_ - 1) / tile_, rows = (size.height + tile_ - 1) / tile_;
    hashes_.resize(static_cast<size_t>(columns) * static_cast<size_t>(rows) * eyes.size());
    auto hash = hashes_.begin();
    for (int eye = 0; eye < size.eyes; ++eye) {
        const Picture& picture = eyes[static_cast<size_t>(eye)];
        const PlaneView plane{PlaneFormat::Rgba8, size.width, size.height, static_cast<ptrdiff_t>(picture.rowBytes()),
                              picture.bgra};
        for (int y = 0; y < size.height; y += tile_)
            for (int x = 0; x < size.width; x += tile_, ++hash) {
                const PixelViewport area{x, y, std::min(tile_, size.width - x), std::min(tile_, size.height - y)};
                Tile tile{frame, size, eye, area, 0, {}};
                const compositor::TileHash now = hashOf(plane.part(tile.area));
                if (!end.isWhole && now == *hash) continue;
                *hash = now;
                ++end.tiles;
                if (auto sent = encodeTile(tile, picture, onTile); !sent) {
                    hashes_.clear();
                    return sent.error();
                }
            }
    }
    return end;
}

// Lossy codecs need red and blue in their places. They encode no alpha, because a wall is opaque.
Result<void> TileEncoder::encodeTile(Tile& tile, const Picture& picture, const OnTile& onTile) {
    constexpr uint32_t kOpaque = 0xff000000;
    const auto width = static_cast<size_t>(tile.area.w);
    PlaneView plane{PlaneFormat::Rgba8, tile.area.w, tile.area.h, static_cast<ptrdiff_t>(picture.rowBytes()),
                    picture.row(tile.area.y) + static_cast<size_t>(tile.area.x) * kPictureBytesPerPixel};
    if (losesColours_) {
        const size_t rowBytes = width * kPictureBytesPerPixel;
        rgba_.resize(rowBytes * static_cast<size_t>(tile.area.h));
        for (int y = 0; y < tile.area.h; ++y)
            swapRedAndBlue(plane.row(y), rgba_.data() + rowBytes * static_cast<size_t>(y), width, kOpaque);
        plane.pixels = rgba_.data();
        plane.strideBytes = static_cast<ptrdiff_t>(rowBytes);
    }
    encoded_.clear();
    tile.codec = encoder_.encode(plane, encoded_);
    tile.bytes = encoded_;
    return onTile(tile);
}

} // namespace mural::remote
