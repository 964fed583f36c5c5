#include <gtest/gtest.h>

#include <cmath>

#include "nodes/overlay/overlay_font.hpp"

namespace mural {
namespace {

constexpr OverlayColour kOpaque{255, 255, 255, 255};

// Returns the bounding box of the drawn pixels.
PixelViewport drawn(const OverlayImage& image) {
    int left = image.width(), right = -1, bottom = image.height(), top = -1;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (image.pixel(x, y)[3] != 0)
                left = std::min(left, x), right = std::max(right, x), bottom = std::min(bottom, y),
                top = std::max(top, y);
    return right < 0 ? PixelViewport{} : PixelViewport{left, bottom, right - left + 1, top - bottom + 1};
}

TEST(OverlayText, staysInItsLine) {
    for (const double height : {6.0, 9.5, 14.0, 33.0, 200.0}) {
        const char* const text = "node 12 on Ágnes_(jq)";
        const double width = overlayTextWidth(text, height);
        OverlayImage image(static_cast<int>(width) + 40, static_cast<int>(height) + 40);
        drawOverlayText(image, text, 20, 20, height, kOpaque);
        const PixelViewport box = drawn(image);
        ASSERT_FALSE(box.empty()) << height;
        EXPECT_GE(box.x, 19) << height;
        EXPECT_LE(box.right(), 20 + width + 1) << height;
        EXPECT_GE(box.y, 19) << height;
        EXPECT_LE(box.top(), 20 + height + 1) << height;
    }
}

TEST(OverlayText, growsWithHeightAndLength) {
    EXPECT_LT(overlayTextWidth("grid", 10), overlayTextWidth("grid", 20));
    EXPECT_LT(overlayTextWidth("grid", 10), overlayTextWidth("grids", 10));
    EXPECT_EQ(overlayTextWidth("", 10), 0);
}

TEST(OverlayText, drawsNothingAtSenselessHeights) {
    OverlayImage image(10, 10);
    for (const double height : {0.0, -5.0, 1e9, std::nan("")}) {
        EXPECT_EQ(overlayTextWidth("a", height), 0);
        drawOverlayText(image, "a", 0, 0, height, kOpaque);
    }
    EXPECT_TRUE(drawn(image).empty());
}

TEST(OverlayText, takesInvalidBytes) {
    OverlayImage image(200, 30);
    drawOverlayText(image, "\xff\xc3 \xe2\x82 \xf0\x9f\x98\x80 \x80", 0, 0, 20, kOpaque);
    EXPECT_FALSE(drawn(image).empty());
}

TEST(OverlayText, isClipped) {
    OverlayImage image(5, 5);
    for (const double at : {-1000.0, -3.0, 2.0, 1000.0}) drawOverlayText(image, "WWW", at, at, 30, kOpaque);
    EXPECT_LE(drawn(image).w, 5);
}

} // namespace
} // namespace mural
