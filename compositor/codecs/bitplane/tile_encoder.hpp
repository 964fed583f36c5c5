// Writes a tile, strip by strip: so the tiles that stand side by side can be encoded together, and memory is read along whole rows.
// Raw where packing gains nothing, one pixel where all are equal.
#pragma once

#include <array>
#include <memory>

#include "compositor/codecs/bitplane/tile_shape.hpp"

namespace mural::compositor::bitplane {

class TileEncoder {
public:
    // The rows are read until finish().
    void begin(const TileShape& shape, const std::byte* rows, ptrdiff_t strideBytes, Predictor predictor);
    // The rows from y on; in order, from 0 in steps of kStripRows.
    void strip(unsigned y);
    // Returns the bytes written; `into` has kTileBoundBytes.
    size_t finish(std::byte* into);

private:
    [[nodiscard]] size_t rawBytes() const { return 1 + shape_.rowBytes() * shape_.rows; }

    TileShape shape_;
    Predictor predictor_ = Predictor::Above;
    const std::byte* rows_ = nullptr;
    ptrdiff_t strideBytes_ = 0;
    const std::byte* pixels_ = nullptr; // the same, in whole blocks
    ptrdiff_t pixelStrideBytes_ = 0;
    size_t size_ = 0;       // of the strips so far, with the kind
    bool uniform_ = false;  // so far
    bool raw_ = false;      // that is less
    alignas(64) std::array<std::byte, kTileRowBytes> above_{}; // row -1: row 0 is predicted from the pixel on its left
    std::unique_ptr<std::byte[]> strips_;
    std::unique_ptr<std::byte[]> padded_; // of a tile at the edge
};

} // namespace mural::compositor::bitplane
