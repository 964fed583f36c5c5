#include "balancer/compound/tiles.hpp"

#include <algorithm>

#include "balancer/compound/frusta.hpp"

namespace mural::compound {

namespace {

constexpr int64_t kMaxTiles = 65536;

int64_t piecesOf(int64_t size, int64_t step) { return (size + step - 1) / step; }

std::vector<PlannedTile> chunksOf(double step) {
    const double size = std::clamp(step, 1. / kMaxTiles, 1.);
    const auto count = static_cast<int64_t>(std::ceil(1 / size - 1e-9));
    std::vector<PlannedTile> chunks;
    for (int64_t i = 0; i < count; ++i)
        chunks.push_back(
            {{}, {}, {static_cast<double>(i) * size, i + 1 == count ? 1 : static_cast<double>(i + 1) * size}});
    return chunks;
}

} // namespace

std::vector<PlannedTile> tilesOf(const PixelViewport& area, const config::PixelsOrRange& size) {
    if (area.empty()) return {};
    if (!size.pixels) {
        auto chunks = chunksOf(size.range.value_or(1));
        for (PlannedTile& c : chunks) c.area = area;
        return chunks;
    }
    int64_t w = std::max<int64_t>(1, size.pixels->x), h = std::max<int64_t>(1, size.pixels->y);
    while (piecesOf(area.w, w) * piecesOf(area.h, h) > kMaxTiles) (w <= h ? w : h) *= 2;
    std::vector<PlannedTile> tiles;
    const int64_t columns = piecesOf(area.w, w), rows = piecesOf(area.h, h);
    for (int64_t row = 0; row < rows; ++row) {
        for (int64_t i = 0; i < columns; ++i) {
            const int64_t column = row % 2 == 0 ? i : columns - 1 - i;
            const PixelViewport tile{static_cast<int32_t>(area.x + column * w), static_cast<int32_t>(area.y + row * h),
                                     static_cast<int32_t>(std::min(w, area.w - column * w)),
                                     static_cast<int32_t>(std::min(h, area.h - row * h))};
            tiles.push_back({tile, relativeTo(tile, area), {}});
        }
    }
    return tiles;
}

RenderContext contextOfTile(const RenderContext& worker, const RenderContext& divided, const PlannedTile& tile) {
    RenderContext c = worker;
    const Viewport part = relativeTo(tile.area, divided.area);
    c.area = tile.area;
    c.viewport.w = tile.area.w;
    c.viewport.h = tile.area.h;
    c.part = compose(divided.part, part);
    c.sampledPart = compose(divided.sampledPart, part);
    c.range = compose(worker.range, tile.range);
    c.x = divided.x;
    c.y = divided.y;
    c.x.origin += c.x.scale * c.x.step * (tile.area.x - divided.area.x);
    c.y.origin += c.y.scale * c.y.step * (tile.area.y - divided.area.y);
    c.perspective = partOf(divided.perspective, part);
    c.orthographic = partOf(divided.orthographic, part);
    return c;
}

} // namespace mural::compound
