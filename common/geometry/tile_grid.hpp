// Division of a picture into columns x rows of tiles. Pure arithmetic, identical on every machine. Row 0 is the lowest
// row (window coordinates).
#pragma once

#include <cstdint>

#include "common/geometry/pixel_viewport.hpp"

namespace mural {

struct TileGrid {
    int columns = 1;
    int rows = 1;
    // Tile origins are multiples of this value. Tiling lean uses 2, so that 2x2 pixel quads stay whole: odd origins
    // raise texture-level mismatches 4 to 40 times (docs/architecture/exactness.md).
    int alignment = 1;
};

// A rectangle of tiles, drawn by one render node.
struct TileRegion {
    int column = 0;
    int row = 0;
    int columns = 1;
    int rows = 1;

    friend bool operator==(const TileRegion&, const TileRegion&) = default;
};

// Returns the position of edge i when `size` pixels are divided into n parts. Requires 0 <= i <= n.
[[nodiscard]] constexpr int32_t tileEdge(int32_t size, int n, int i, int alignment) {
    if (i <= 0) return 0;
    if (i >= n) return size;
    const auto edge = static_cast<int32_t>(static_cast<int64_t>(size) * i / n);
    return edge / alignment * alignment;
}

[[nodiscard]] constexpr PixelViewport regionViewport(const TileGrid& g, const TileRegion& r, int32_t width,
                                                     int32_t height) {
    const int32_t x0 = tileEdge(width, g.columns, r.column, g.alignment);
    const int32_t x1 = tileEdge(width, g.columns, r.column + r.columns, g.alignment);
    const int32_t y0 = tileEdge(height, g.rows, r.row, g.alignment);
    const int32_t y1 = tileEdge(height, g.rows, r.row + r.rows, g.alignment);
    return {x0, y0, x1 - x0, y1 - y0};
}

[[nodiscard]] constexpr PixelViewport tileViewport(const TileGrid& g, int column, int row, int32_t width,
                                                   int32_t height) {
    return regionViewport(g, {column, row, 1, 1}, width, height);
}

} // namespace mural
