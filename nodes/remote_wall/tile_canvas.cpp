#include "nodes/remote_wall/tile_canvas.hpp"

#include <algorithm>

#include "nodes/frame_transfer/bgra_swizzle.hpp"

namespace mural::remote {

Result<void> TileCanvas::apply(const CompleteFrame& frame) {
    if (frame.size != size_) {
        size_ = frame.size;
        for (int eye = 0; eye < size_.eyes; ++eye) {
            OwnedPicture& picture = pictures_[static_cast<size_t>(eye)];
            picture.resize(size_.width, size_.height);
            std::fill_n(picture.data(), picture.view().sizeBytes(), std::byte{0}); // no memory of other pictures
        }
    }
    for (const StoredTile& tile : frame.tiles) {
        OwnedPicture& picture = pictures_[static_cast<size_t>(tile.eye)];
        const compositor::MutablePlaneView whole{compositor::PlaneFormat::Rgba8, size_.width, size_.height,
                                                 static_cast<ptrdiff_t>(picture.rowBytes()), picture.data()};
        const compositor::MutablePlaneView part = whole.part(tile.area);
        if (auto decoded = decoder_.decode(tile.codec, tile.bytes, part); !decoded) return decoded;
        for (int y = 0; losesColours_ && y < part.height; ++y)
            swapRedAndBlue(part.row(y), part.row(y), static_cast<size_t>(part.width));
    }
    return {};
}

} // namespace mural::remote
