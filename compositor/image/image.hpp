// What one channel hands to another: colour, depth, or both, where they stand in the picture that they are a part of, which of
// their pixels were drawn, and in what order.
#pragma once

#include <optional>
#include <utility>

#include "compositor/image/draw_order.hpp"
#include "compositor/image/plane.hpp"
#include "compositor/image/region.hpp"

namespace mural::compositor {

struct Image {
    int32_t x = 0; // of its lower left pixel, in the picture
    int32_t y = 0;
    std::optional<Plane> colour;
    std::optional<Plane> depth; // of the same size, when there are both
    Region drawn;               // in its own pixels; nothing outside needs to be carried or put anywhere
    DrawOrder order;

    [[nodiscard]] int32_t width() const { return colour ? colour->width() : depth ? depth->width() : 0; }
    [[nodiscard]] int32_t height() const { return colour ? colour->height() : depth ? depth->height() : 0; }
    [[nodiscard]] PixelViewport area() const { return {x, y, width(), height()}; }
};

} // namespace mural::compositor
