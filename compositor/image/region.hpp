// A set of pixels as disjoint rectangles: the drawn or transferred part of a picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"

namespace mural::compositor {

class Region {
public:
    Region() = default;
    explicit Region(const PixelViewport& area) { add(area); }

    // Adds an area; pixels already in the set are not duplicated. Linear in the number of rectangles.
    void add(const PixelViewport& area);
    void add(const Region& other);
    void subtract(const PixelViewport& area);
    void move(int32_t dx, int32_t dy);
    // Merges rectangles whose union is a rectangle.
    void simplify();

    [[nodiscard]] bool empty() const { return rectangles_.empty(); }
    [[nodiscard]] int64_t area() const;
    [[nodiscard]] PixelViewport bounds() const;
    [[nodiscard]] bool contains(int32_t x, int32_t y) const;
    [[nodiscard]] bool covers(const PixelViewport& area) const;
    [[nodiscard]] Region intersected(const PixelViewport& area) const;
    [[nodiscard]] Region intersected(const Region& other) const;
    // In unspecified order.
    [[nodiscard]] std::span<const PixelViewport> rectangles() const { return rectangles_; }

private:
    std::vector<PixelViewport> rectangles_;
};

} // namespace mural::compositor
