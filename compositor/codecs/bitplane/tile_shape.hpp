// A tile: up to 256 x 64 words that are encoded on their own, so that tiles can be decoded one by one and by many threads.
#pragma once

#include "compositor/codecs/bitplane/bitplane_format.hpp"

namespace mural::compositor::bitplane {

constexpr size_t kTileRowBytes = size_t{4} * kTileColumns;
constexpr size_t kTileBytes = kTileRowBytes * kTileRows;
// Of what a tile may become: a kind, and the strips or the raw rows, whichever is more.
constexpr size_t kTileBoundBytes = 1 + (kTileRows / kStripRows) * kStripBoundBytes + kSlackBytes;

enum class TileKind : uint8_t { Raw = 0, Uniform = 1, Strips = 2 }; // Strips: plus the predictor's number

// Words of any number up to a tile's, in rows.
struct TileShape {
    unsigned columns = 0;
    unsigned rows = 0;
    unsigned wordsPerPixel = 1;
    Arithmetic arithmetic = Arithmetic::Bytes;

    [[nodiscard]] size_t rowBytes() const { return size_t{4} * columns; }
    [[nodiscard]] size_t pixelBytes() const { return size_t{4} * wordsPerPixel; }
    [[nodiscard]] unsigned wholeBlocks() const { return (columns + kBlockColumns - 1) / kBlockColumns; }
    [[nodiscard]] unsigned wholeStrips() const { return (rows + kStripRows - 1) / kStripRows; }
    [[nodiscard]] bool hasWholeBlocks() const { return columns % kBlockColumns == 0 && rows % kStripRows == 0; }
    // Of the strip from row y on, no more than there are.
    [[nodiscard]] unsigned rowsFrom(unsigned y) const { return rows - y < kStripRows ? rows - y : kStripRows; }
};

} // namespace mural::compositor::bitplane
