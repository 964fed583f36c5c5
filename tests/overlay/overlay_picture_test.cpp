#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "common/geometry/tile_grid.hpp"
#include "nodes/overlay/overlay.hpp"
#include "nodes/overlay/overlay_picture.hpp"

namespace mural {
namespace {

using Rgba = std::array<uint8_t, 4>;
constexpr Rgba kWhite{255, 255, 255, 255}, kGreen{0, 255, 0, 255};

OverlayPlace placeOf(PixelViewport part, int wallWidth, int wallHeight) {
    OverlayPlace place;
    place.title = "Mural tile 0";
    place.part = part;
    place.wallWidth = wallWidth;
    place.wallHeight = wallHeight;
    return place;
}

OverlayContent contentOf(OverlayMode mode, size_t nodes = 2) {
    OverlayContent content;
    content.mode = mode;
    content.host = "render-host-with-a-long-name";
    content.role = "node 2";
    for (size_t node = 0; node < nodes; ++node) {
        FrameHistory history;
        for (uint32_t frame = 1; frame <= 60; ++frame) {
            FrameParts parts{frame, frame * 16'000'000LL, {}};
            parts.ms = {1, 5, 2, 0, 1, 1, 0, 1, 4 + frame % 3 * 1.0};
            history.add(parts);
        }
        content.nodes.push_back({"node " + std::to_string(node) + " on local", history});
    }
    return content;
}

// Returns the image of the whole wall, composed from those of its windows.
std::vector<Rgba> wallOf(const OverlayContent& content, OverlayPlace place, const std::vector<PixelViewport>& windows) {
    std::vector<Rgba> wall(static_cast<size_t>(place.wallWidth * place.wallHeight));
    for (const PixelViewport& window : windows) {
        place.part = window;
        const OverlayImage image = drawOverlay(content, place);
        for (int y = 0; y < window.h; ++y)
            for (int x = 0; x < window.w; ++x)
                wall[static_cast<size_t>((window.y + y) * place.wallWidth + window.x + x)] = image.pixel(x, y);
    }
    return wall;
}

// Returns whether the pixel is one of a window's border, grey steps or labels, which each window has for itself.
bool isOwn(const std::vector<PixelViewport>& windows, int x, int y) {
    for (const PixelViewport& w : windows) {
        if (x < w.x || y < w.y || x >= w.right() || y >= w.top()) continue;
        const bool border = x == w.x || y == w.y || x == w.right() - 1 || y == w.top() - 1;
        return border || (y - w.y >= w.h / 8 && y - w.y <= w.h / 8 + w.h / 16);
    }
    return false;
}

void expectContinuous(const OverlayPlace& place, const std::vector<PixelViewport>& windows) {
    const OverlayContent content = contentOf(OverlayMode::Grid);
    const std::vector<PixelViewport> one = {{0, 0, place.wallWidth, place.wallHeight}};
    const auto whole = wallOf(content, place, one), parts = wallOf(content, place, windows);
    int differing = 0;
    for (int y = 0; y < place.wallHeight; ++y)
        for (int x = 0; x < place.wallWidth; ++x) {
            const size_t i = static_cast<size_t>(y * place.wallWidth + x);
            if (!isOwn(one, x, y) && !isOwn(windows, x, y) && whole[i] != parts[i]) ++differing;
        }
    EXPECT_EQ(differing, 0);
}

TEST(OverlayGrid, continuesAcrossWindows) {
    // no boundary is on a line; windows of odd sizes, with 1 pixel
    expectContinuous(placeOf({}, 803, 605),
                     {{0, 0, 401, 302}, {401, 0, 402, 302}, {0, 302, 401, 303}, {401, 302, 402, 303}});
    // boundaries next to lines
    expectContinuous(placeOf({}, 803, 605), {{0, 0, 400, 605}, {400, 0, 1, 605}, {401, 0, 402, 605}});
}

TEST(OverlayGrid, continuesInMillimetres) {
    OverlayPlace place = placeOf({}, 800, 600);
    place.wallWidthMm = 2222.5;
    place.wallHeightMm = 1250;
    expectContinuous(place, {{0, 0, 333, 600}, {333, 0, 467, 277}, {333, 277, 467, 323}});
}

TEST(OverlayGrid, hasALineEveryHundredPixels) {
    const OverlayImage image = drawOverlay(contentOf(OverlayMode::Grid), placeOf({350, 250, 300, 200}, 1000, 800));
    for (const int x : {50, 150, 250}) EXPECT_EQ(image.pixel(x, 100), kWhite) << x;
    for (const int y : {50, 150}) EXPECT_EQ(image.pixel(33, y), kWhite) << y;
    EXPECT_NE(image.pixel(51, 101), kWhite);
    EXPECT_NE(image.pixel(49, 101), kWhite);
}

TEST(OverlayGrid, hasALineEveryHundredMillimetres) {
    OverlayPlace place = placeOf({0, 0, 500, 400}, 1000, 800);
    place.wallWidthMm = 2500;  // 40 pixels per step
    place.wallHeightMm = 1000; // 80 pixels per step
    const OverlayImage image = drawOverlay(contentOf(OverlayMode::Grid), place);
    for (const int x : {40, 80, 120, 160}) EXPECT_EQ(image.pixel(x, 333), kWhite) << x;
    for (const int y : {80, 160}) EXPECT_EQ(image.pixel(15, y), kWhite) << y;
    EXPECT_NE(image.pixel(15, 40), kWhite);
}

TEST(OverlayGrid, hasABorderOfOnePixelAtTheEdge) {
    const OverlayImage image = drawOverlay(contentOf(OverlayMode::Grid), placeOf({130, 70, 211, 117}, 1000, 800));
    for (int x = 0; x < 211; ++x) {
        EXPECT_EQ(image.pixel(x, 0), kGreen);
        EXPECT_EQ(image.pixel(x, 116), kGreen);
    }
    for (int y = 0; y < 117; ++y) {
        EXPECT_EQ(image.pixel(0, y), kGreen);
        EXPECT_EQ(image.pixel(210, y), kGreen);
    }
    EXPECT_NE(image.pixel(1, 1), kGreen);
    EXPECT_NE(image.pixel(209, 115), kGreen);
}

TEST(OverlayGrid, hasSixteenGreySteps) {
    const OverlayImage image = drawOverlay(contentOf(OverlayMode::Grid), placeOf({0, 0, 640, 480}, 640, 480));
    const int y = 480 / 8 + 480 / 32;
    std::vector<int> greys;
    for (int x = 1; x < 639; ++x) {
        const Rgba p = image.pixel(x, y);
        if (p[3] == 255 && p[0] == p[1] && p[1] == p[2] && (greys.empty() ? p[0] == 0 : p[0] > greys.back()))
            greys.push_back(p[0]);
    }
    ASSERT_EQ(greys.size(), 16U);
    EXPECT_EQ(greys.back(), 255);
}

TEST(OverlayNames, fitTheWindow) {
    for (const auto& [w, h] : {std::pair{1920, 1080}, {300, 1080}, {1920, 60}, {64, 48}}) {
        const OverlayImage image = drawOverlay(contentOf(OverlayMode::Names), placeOf({0, 0, w, h}, w, h));
        int bright = 0;
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const bool isText = image.pixel(x, y)[0] > 200;
                bright += isText ? 1 : 0;
                const bool isEdge = x == 0 || y == 0 || x == w - 1 || y == h - 1;
                EXPECT_FALSE(isEdge && isText) << w << "x" << h << " " << x << "," << y;
            }
        EXPECT_GT(bright, w * h / 200) << w << "x" << h;
    }
}

TEST(OverlayNames, areAtMostTwoFifthsHigh) {
    OverlayContent content = contentOf(OverlayMode::Names);
    content.role = "I";
    content.host = "";
    OverlayPlace place = placeOf({0, 0, 2000, 100}, 2000, 100);
    place.title = "";
    const OverlayImage image = drawOverlay(content, place);
    int lowest = 100, highest = -1;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 2000; ++x) // the area's line is of another colour
            if (image.pixel(x, y) == kWhite) lowest = std::min(lowest, y), highest = std::max(highest, y);
    EXPECT_GT(highest, lowest);
    EXPECT_LE(highest - lowest + 1, 40);
}

TEST(OverlayStats, showEveryNodeThatFits) {
    const OverlayPlace place = placeOf({0, 0, 1280, 720}, 1280, 720);
    const auto covered = [&](size_t nodes) {
        const OverlayImage image = drawOverlay(contentOf(OverlayMode::Stats, nodes), place);
        int count = 0;
        for (int y = 0; y < 720; ++y)
            for (int x = 0; x < 1280; ++x) count += image.pixel(x, y)[3] != 0 ? 1 : 0;
        return count;
    };
    EXPECT_EQ(covered(0), 0);
    EXPECT_GT(covered(1), 1000);
    EXPECT_NEAR(covered(4), 4 * covered(1), 4000);
    EXPECT_GT(covered(100), covered(12));
}

TEST(OverlayPicture, drawsAnySize) {
    for (const OverlayMode mode : {OverlayMode::Off, OverlayMode::Stats, OverlayMode::Names, OverlayMode::Grid})
        for (const auto& [w, h] :
             {std::pair{1, 1}, {2, 1}, {1, 2}, {1, 500}, {500, 1}, {2, 2}, {3, 3}, {16, 4}, {0, 0}, {-5, 7}}) {
            const OverlayImage image = drawOverlay(contentOf(mode, 30), placeOf({5, 5, w, h}, 1000, 800));
            EXPECT_EQ(image.width(), std::max(w, 0));
            OverlayPlace unknown = placeOf({5, 5, w, h}, 0, 0);
            unknown.wallWidthMm = unknown.wallHeightMm = 1000;
            (void)drawOverlay(contentOf(mode), unknown);
        }
}

TEST(OverlayPicture, endsForExtremeDensities) {
    OverlayPlace place = placeOf({0, 0, 300, 200}, 300, 200);
    for (const double mm : {1e-9, 0.1, 1e4, 1e6, 1e300}) {
        place.wallWidthMm = place.wallHeightMm = mm;
        (void)drawOverlay(contentOf(OverlayMode::Grid), place);
    }
}

TEST(OverlayImage, drawsOverPictures) {
    OverlayImage image(3, 1);
    image.fill({1, 0, 1, 1}, {255, 0, 0, 255});
    image.fill({2, 0, 1, 1}, {255, 255, 255, 51});
    const uint32_t below[3] = {0x00102030, 0x00102030, 0x80204060};
    uint32_t shown[3];
    std::memcpy(shown, below, sizeof below);
    image.drawOver(reinterpret_cast<std::byte*>(shown), PictureFormat::Bgra8);
    EXPECT_EQ(shown[0], below[0]);
    EXPECT_EQ(shown[1], 0xffff0000U);
    EXPECT_EQ(shown[2] >> 16 & 255, 77U); // 32 * 0.8 + 255 * 0.2
    const uint32_t deep = 3U << 30 | 1000U << 20 | 513U << 10 | 7;
    uint32_t ten[3] = {deep, deep, deep};
    image.drawOver(reinterpret_cast<std::byte*>(ten), PictureFormat::Bgr10A2);
    EXPECT_EQ(ten[0], deep); // keeps all bits
    EXPECT_EQ(ten[1], 3U << 30 | 1023U << 20);
}

TEST(Overlay, changesItsVersionWithItsContent) {
    Overlay overlay("host", "head");
    const uint64_t first = overlay.version();
    overlay.setMode(OverlayMode::Off);
    overlay.setNodes({{"node 0", {}}}); // without effect: it shows no numbers
    EXPECT_EQ(overlay.version(), first);
    overlay.setMode(OverlayMode::Stats);
    const uint64_t second = overlay.version();
    EXPECT_NE(second, first);
    overlay.setNodes({{"node 0", {}}});
    EXPECT_NE(overlay.version(), second);
    EXPECT_EQ(overlay.content().nodes.size(), 1U);
    overlay.setMode(OverlayMode::Names);
    EXPECT_TRUE(overlay.content().nodes.empty());
    EXPECT_EQ(overlay.content().role, "head");
}

} // namespace
} // namespace mural
