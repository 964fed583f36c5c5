// Decodes a tile strip by strip, so adjacent tiles can be decoded together and memory is written along whole rows.
// Functions return an error text, or null.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "compositor/codecs/bitplane/tile_shape.hpp"

namespace mural::compositor::bitplane {

class TileDecoder {
public:
    // Begins a tile of exactly these bytes. Bytes and rows must stay valid until finish().
    const char* begin(const TileShape& shape, std::span<const std::byte> bytes, std::byte* rows, ptrdiff_t strideBytes);
    // Decodes the rows from y on. Call with y = 0, kStripRows, 2 * kStripRows, and so on.
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
    // row -1 of strips, which is zero; or the row of a uniform tile
    alignas(64) std::array<std::byte, kTileRowBytes> row_{};
    std::array<std::byte, kStripBoundBytes + 2 * kSlackBytes> ending_{}; // copy of the last bytes, with slack
    std::unique_ptr<std::byte[]> padded_;                                // for a tile at the edge
};

} // namespace mural::compositor::bitplane
