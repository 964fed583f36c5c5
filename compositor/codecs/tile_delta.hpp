// Tile delta: sends the tiles of a plane that changed since the previous one, detected by 128-bit hashes. Each run of
// changed tiles is encoded with any codec. Both ends keep state: the encoder the hashes, the receiver the plane.
//
// Format: number of this plane and of its reference (4 bytes each; 0: none, all tiles follow), one bit per tile,
// row-major from the lowest row, then for each run its size (4 bytes) and its data.
#pragma once

#include <vector>

#include "compositor/codecs/codec.hpp"
#include "compositor/image/tile_hash.hpp"

namespace mural::compositor {

constexpr int32_t kSkippedTileColumns = 256; // in pixels
constexpr int32_t kSkippedTileRows = 64;

class TileDeltaEncoder {
public:
    [[nodiscard]] size_t boundBytes(const PlaneShape& shape, const Codec& codec) const;
    // Requires that the receiver gets all planes in this order. A plane of another shape is sent whole.
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, Codec& codec, std::span<std::byte> into);
    // Sends the next plane whole: the receiver is new, or has lost its plane.
    void restart() { names_.clear(); }
    [[nodiscard]] size_t changedTiles() const { return changed_; } // of the last plane

private:
    PlaneShape shape_;
    std::vector<TileHash> names_; // empty: nothing was sent
    uint32_t number_ = 0;
    size_t changed_ = 0;
};

class TileDeltaDecoder {
public:
    // Updates `into`, which must hold the result of the last call. Errors: another reference plane, or malformed data;
    // the encoder must then restart.
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, Codec& codec, const MutablePlaneView& into);

private:
    uint32_t number_ = 0; // number of the receiver's plane; 0: none
};

} // namespace mural::compositor
