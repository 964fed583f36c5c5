// A tile: up to 256 x 64 words that are encoded on their own, so that tiles can be decoded one by one and by many threads.
// Written raw where packing gains nothing, and as one pixel where all are equal.
#pragma once

#include <memory>
#include <span>

#include "compositor/codecs/bitplane/bitplane_format.hpp"

namespace mural::compositor::bitplane {

constexpr size_t kTileBytes = size_t{4} * kTileColumns * kTileRows;
// Of what encodeTile may write: a kind, and the strips or the raw rows, whichever is more.
constexpr size_t kTileBoundBytes = 1 + (kTileRows / kStripRows) * kStripBoundBytes + kSlackBytes;

// Words of any number up to a tile's, in rows.
struct TileShape {
    unsigned columns = 0;
    unsigned rows = 0;
    unsigned wordsPerPixel = 1;
    Arithmetic arithmetic = Arithmetic::Bytes;
};

class TileCoder {
public:
    TileCoder();
    // Returns the bytes written; `into` has kTileBoundBytes.
    size_t encode(const TileShape& shape, const std::byte* rows, ptrdiff_t strideBytes, Predictor predictor, std::byte* into);
    // Returns what is wrong with the bytes, or null. All of them are the tile.
    const char* decode(const TileShape& shape, std::span<const std::byte> bytes, std::byte* rows, ptrdiff_t strideBytes);

private:
    const char* decodeStrips(const TileShape& shape, std::span<const std::byte> bytes, Predictor predictor, std::byte* rows, ptrdiff_t strideBytes);

    struct Scratch {
        alignas(64) std::byte pixels[kTileBytes];          // a tile at the edge, made whole blocks
        alignas(64) std::byte above[4 * kTileColumns];     // row -1 of the first strip
std::byte ending[kStripBoundBytes + 2 * kSlackBytes]; // the last encoded bytes of a tile, with room behind them
    };
    std::unique_ptr<Scratch> scratch_;
};

} // namespace mural::compositor::bitplane
