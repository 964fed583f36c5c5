// Encodes a tile strip by strip, so adjacent tiles can be encoded together and memory is read along whole rows. Falls
// back to raw rows without a gain, and to one pixel for uniform tiles.
#pragma once

#include <array>
#include <memory>

#include "compositor/codecs/bitplane/tile_shape.hpp"

namespace mural::compositor::bitplane {

class TileEncoder {
public:
    // The rows must stay valid until finish().
    void begin(const TileShape& shape, const std::byte* rows, ptrdiff_t strideBytes, Predictor predictor);
    // Encodes the rows from y on. Call with y = 0, kStripRows, 2 * kStripRows, and so on.
    void strip(unsigned y);
    // Returns the number of bytes written. Requires kTileBoundBytes in `into`.
    size_t finish(std::byte* into);

private:
    [[nodiscard]] size_t rawBytes() const { return 1 + shape_.rowBytes() * shape_.rows; }

    TileShape shape_;
    Predictor predictor_ = Predictor::Above;
    const std::byte* rows_ = nullptr;
    ptrdiff_t strideBytes_ = 0;
    const std::byte* pixels_ = nullptr; // the same, in whole blocks
    ptrdiff_t pixelStrideBytes_ = 0;
    size_t size_ = 0;                                          // of the strips so far, including the kind
    bool uniform_ = false;                                     // so far
    bool raw_ = false;                                         // raw rows are smaller
    alignas(64) std::array<std::byte, kTileRowBytes> above_{}; // row -1: row 0 is predicted from the pixel to its left
    std::unique_ptr<std::byte[]> strips_;
    std::unique_ptr<std::byte[]> padded_; // for a tile at the edge
};

} // namespace mural::compositor::bitplane
