// A picture passed between channels: colour, depth, or both; its place in the whole picture, its drawn pixels, and its
// draw order.
#pragma once

#include <optional>
#include <utility>

#include "compositor/image/draw_order.hpp"
#include "compositor/image/plane.hpp"
#include "compositor/image/region.hpp"

namespace mural::compositor {

struct Image {
    int32_t x = 0; // lower left pixel within the whole picture
    int32_t y = 0;
    std::optional<Plane> colour;
    std::optional<Plane> depth; // size equal to colour's
    Region drawn;               // in its own pixels; pixels outside carry no data
    DrawOrder order;

    [[nodiscard]] int32_t width() const { return colour ? colour->width() : depth ? depth->width() : 0; }
    [[nodiscard]] int32_t height() const { return colour ? colour->height() : depth ? depth->height() : 0; }
    [[nodiscard]] PixelViewport area() const { return {x, y, width(), height()}; }
};

} // namespace mural::compositor
