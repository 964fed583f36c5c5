// Sends of a plane only the tiles that changed since the one before, by their 128-bit names; each run of changed tiles is
// encoded by any codec. Both ends keep state: the encoder the names, the receiver the plane itself.
//
// Bytes: number of this plane and of the one it changes (4 bytes each; 0: none, all tiles are here), a bit for each tile that
// is here, row by row from the lowest, then for each run of them in a row its size (4 bytes) and its bytes.
#pragma once

#include <vector>

#include "compositor/codecs/codec.hpp"
#include "compositor/image/tile_hash.hpp"

namespace mural::compositor {

constexpr int32_t kSkippedTileColumns = 256; // pixels
constexpr int32_t kSkippedTileRows = 64;

class UnchangedTilesEncoder {
public:
    [[nodiscard]] size_t boundBytes(const PlaneShape& shape, const Codec& codec) const;
    // The receiver gets all planes in this order. A plane of another shape begins anew by itself.
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, Codec& codec, std::span<std::byte> into);
    // The next plane is sent whole: the receiver is another one, or has lost its plane.
    void restart() { names_.clear(); }
    [[nodiscard]] size_t changedTiles() const { return changed_; } // of the last plane

private:
    PlaneShape shape_;
    std::vector<TileHash> names_; // empty: nothing was sent
    uint32_t number_ = 0;
    size_t changed_ = 0;
};

class UnchangedTilesDecoder {
public:
    // `into` holds what the last call left there. Errors: bytes that build on another plane than the last, or are damaged;
    // then the encoder must restart.
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, Codec& codec, const MutablePlaneView& into);

private:
    uint32_t number_ = 0; // of the plane that the receiver holds; 0: none
};

} // namespace mural::compositor
