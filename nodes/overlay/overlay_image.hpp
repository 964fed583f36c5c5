// The pixels of an overlay, and the shapes that it consists of. Rows begin with the lowest one, as in pictures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/picture_format.hpp"
#include "common/geometry/pixel_viewport.hpp"

namespace mural {

struct OverlayColour {
    uint8_t red = 255, green = 255, blue = 255;
    uint8_t alpha = 255; // 255: opaque

    friend constexpr bool operator==(const OverlayColour&, const OverlayColour&) = default;
};

// A picture with transparency. Shapes are clipped to it.
class OverlayImage {
public:
    OverlayImage() = default;
    // Transparent. width, height: 0 or more.
    OverlayImage(int width, int height);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    // Red, green, blue, each multiplied with alpha, and alpha.
    [[nodiscard]] std::array<uint8_t, 4> pixel(int x, int y) const;

    // Draws over the pixel. coverage: covered part of the pixel, 0 to 1.
    void plot(int x, int y, OverlayColour colour, double coverage = 1);
    void fill(PixelViewport area, OverlayColour colour);
    // The outermost pixels of the area.
    void frame(PixelViewport area, OverlayColour colour);

    struct Ring {
        double x = 0, y = 0;           // centre, in pixels
        double scaleX = 1, scaleY = 1; // units per pixel
        double radius = 1;             // in units
        double halfWidth = 1;          // of the line, in pixels
    };
    void ring(const Ring& ring, OverlayColour colour);

    // Draws the overlay over a picture of the same size without padding between rows (Picture, nodes/output).
    void drawOver(std::byte* pixels, PictureFormat format) const;

private:
    [[nodiscard]] size_t at(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
    }
    void widen(int y, int first, int end);

    int width_ = 0, height_ = 0;
    std::vector<uint32_t> pixels_; // blue in the lowest bits, green, red, alpha; colours are multiplied with alpha
    struct Extent {
        int first = 0, end = 0;
    };
    std::vector<Extent> rows_; // the part of each row outside of which it is transparent
};

} // namespace mural
