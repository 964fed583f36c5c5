// A tile: up to 256 x 64 words, encoded independently, so tiles can be decoded one by one and by several threads.
#pragma once

#include "compositor/codecs/bitplane/bitplane_format.hpp"

namespace mural::compositor::bitplane {

constexpr size_t kTileRowBytes = size_t{4} * kTileColumns;
constexpr size_t kTileBytes = kTileRowBytes * kTileRows;
// Largest encoded tile: a kind, and strips or raw rows, whichever is larger.
constexpr size_t kTileBoundBytes = 1 + (kTileRows / kStripRows) * kStripBoundBytes + kSlackBytes;

enum class TileKind : uint8_t { Raw = 0, Uniform = 1, Strips = 2 }; // Strips: plus the number of the predictor

// Size of a tile in words.
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
    // Rows of the strip that begins at y, fewer at the edge.
    [[nodiscard]] unsigned rowsFrom(unsigned y) const { return rows - y < kStripRows ? rows - y : kStripRows; }
};

} // namespace mural::compositor::bitplane
