#include "nodes/replay/enlarge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace mural {

namespace {

// Between which two pixels one of the large picture lies, and how far from the first: in 256ths, so that no machine rounds otherwise.
struct Between {
    int32_t first, second;
    uint32_t weight; // of the second
};

Between between(int32_t large, double zoom, int32_t from, int32_t count) {
    const auto at = static_cast<int64_t>(std::lround(((large + 0.5) * zoom - 0.5 - from) * 256));
    const int64_t first = at >> 8;
    const auto inside = [&](int64_t i) { return static_cast<int32_t>(std::clamp<int64_t>(i, 0, count - 1)); };
    return {inside(first), inside(first + 1), static_cast<uint32_t>(at & 255)};
}

} // namespace

void enlarge(const SmallPicture& from, const Zoom& zoom, const PixelViewport& r, std::byte* into, const PixelViewport& box) {
    if (from.area.empty() || r.empty()) return;
    std::vector<Between> columns;
    for (int32_t x = r.x; x < r.right(); ++x) columns.push_back(between(x, zoom.x, from.area.x, from.area.w));
    const auto* pixels = reinterpret_cast<const uint8_t*>(from.pixels);
    const auto rowBytes = static_cast<size_t>(from.area.w) * 4;
    for (int32_t y = r.y; y < r.top(); ++y) {
        const Between row = between(y, zoom.y, from.area.y, from.area.h);
        const uint8_t *lower = pixels + static_cast<size_t>(row.first) * rowBytes, *upper = pixels + static_cast<size_t>(row.second) * rowBytes;
        auto* to = reinterpret_cast<uint8_t*>(into) + (static_cast<size_t>(y - box.y) * static_cast<size_t>(box.w) + static_cast<size_t>(r.x - box.x)) * 4;
        for (const Between& column : columns)
            for (size_t c = 0; c < 4; ++c) {
                const size_t a = static_cast<size_t>(column.first) * 4 + c, b = static_cast<size_t>(column.second) * 4 + c;
                const uint32_t below = lower[a] * (256 - column.weight) + lower[b] * column.weight, above = upper[a] * (256 - column.weight) + upper[b] * column.weight;
                *to++ = static_cast<uint8_t>((below * (256 - row.weight) + above * row.weight + 32768) >> 16);
            }
    }
}

} // namespace mural
