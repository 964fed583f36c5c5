// Reads a tile, strip by strip: so the tiles that stand side by side can be decoded together, and memory is written along whole rows.
// Each function returns what is wrong with the bytes, or null.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "compositor/codecs/bitplane/tile_shape.hpp"

namespace mural::compositor::bitplane {

class TileDecoder {
public:
    // All of the bytes are the tile; they are read, and the rows written, until finish().
    const char* begin(const TileShape& shape, std::span<const std::byte> bytes, std::byte* rows, ptrdiff_t strideBytes);
    // The rows from y on; in order, from 0 in steps of kStripRows.
    const char* strip(unsigned y);
    const char* finish() const;

private:
    const char* packedStrip(unsigned y);
    void copyRows(unsigned y, const std::byte* from, ptrdiff_t fromStrideBytes);

    TileShape shape_;
    TileKind kind_ = TileKind::Raw;
    Predictor predictor_ = Predictor::Above;
    std::span<const std::byte> left_;
    std::byte* rows_ = nullptr;
    ptrdiff_t strideBytes_ = 0;
    std::byte* pixels_ = nullptr; // the same, in whole blocks
    ptrdiff_t pixelStrideBytes_ = 0;
    bool moved_ = false;
    ParsedStrip strip_;
    alignas(64) std::array<std::byte, kTileRowBytes> row_{}; // of strips row -1, which is 0; a uniform tile's
    std::array<std::byte, kStripBoundBytes + 2 * kSlackBytes> ending_{}; // the last of the bytes, with room behind them
    std::unique_ptr<std::byte[]> padded_; // of a tile at the edge
};

} // namespace mural::compositor::bitplane
