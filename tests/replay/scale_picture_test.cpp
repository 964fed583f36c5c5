// Scaling of pictures for zoom.
#include "nodes/frame_transfer/scale_picture.hpp"

#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <vector>

#include "nodes/player/pixel_mapping.hpp"

namespace mural {
namespace {

std::vector<std::byte> scaled(const std::vector<std::byte>& drawn, const PixelViewport& area, const Zoom& zoom,
                              const PixelViewport& box) {
    std::vector<std::byte> into(static_cast<size_t>(box.area()) * 4);
    scalePicture({drawn.data(), area}, zoom, box, into.data(), box);
    return into;
}

// value(x, y), in all four bytes
template <typename Value> std::vector<std::byte> picture(const PixelViewport& area, const Value& value) {
    std::vector<std::byte> bytes;
    for (int y = 0; y < area.h; ++y)
        for (int x = 0; x < area.w; ++x) bytes.insert(bytes.end(), 4, static_cast<std::byte>(value(x, y)));
    return bytes;
}

int at(const std::vector<std::byte>& bytes, const PixelViewport& box, int x, int y) {
    return std::to_integer<int>(
        bytes[(static_cast<size_t>(y) * static_cast<size_t>(box.w) + static_cast<size_t>(x)) * 4]);
}

TEST(ScalePicture, changesNothingWithoutZoom) {
    std::vector<std::byte> drawn;
    for (int i = 0; i < 7 * 5 * 4; ++i) drawn.push_back(static_cast<std::byte>(i * 37));
    EXPECT_EQ(scaled(drawn, {3, 2, 7, 5}, {1, 1}, {3, 2, 7, 5}), drawn);
}

// A ramp stays a ramp: between two centres values are interpolated by distance.
TEST(ScalePicture, interpolatesLinearlyToEnlarge) {
    RenderPass pass;
    pass.zoom = {0.25, 0.25};
    const PixelViewport box{40, 0, 80, 8}, area = inPass(pass, box);
    ASSERT_EQ(area, (PixelViewport{10, 0, 20, 2}));
    const auto drawn = picture(area, [](int x, int) { return 8 * x; });
    const auto shown = scaled(drawn, area, pass.zoom, box);
    for (int x = 2; x < box.w - 2; ++x) EXPECT_NEAR(at(shown, box, x, 3), 8 * ((x + 0.5) / 4 - 0.5), 0.51) << x;
    EXPECT_EQ(shown[0], drawn[0]) << "the outermost pixels count on";
    EXPECT_EQ(shown.back(), drawn.back());
}

// Each pixel is the mean of the area that it covers, including single lines and points.
TEST(ScalePicture, averagesToReduce) {
    const PixelViewport box{5, 3, 10, 6};
    for (const int zoom : {2, 3, 5}) {
        const PixelViewport area{5 * zoom, 3 * zoom, 10 * zoom, 6 * zoom};
        const auto shown = scaled(picture(area, [&](int x, int y) { return x % zoom == 0 && y % zoom == 0 ? 250 : 0; }),
                                  area, {double(zoom), double(zoom)}, box);
        for (int y = 0; y < box.h; ++y)
            for (int x = 0; x < box.w; ++x) ASSERT_NEAR(at(shown, box, x, y), 250.0 / (zoom * zoom), 1) << zoom;
    }
}

// For any zoom, brightness does not increase, and a uniform picture stays exactly uniform.
TEST(ScalePicture, writesAPartAsTheWhole) {
    const PixelViewport box{40, 20, 60, 40};
    for (const Zoom& zoom : {Zoom{0.4, 0.7}, Zoom{1.6, 2.3}, Zoom{0.5, 3}}) {
        RenderPass pass;
        pass.zoom = zoom;
        const PixelViewport area = inPass(pass, box);
        std::mt19937 random(3);
        std::vector<std::byte> drawn(static_cast<size_t>(area.area()) * 4);
        for (std::byte& b : drawn) b = static_cast<std::byte>(random() & 255);
        const auto whole = scaled(drawn, area, zoom, box);
        const PixelViewport part{57, 31, 22, 9};
        std::vector<std::byte> into(whole.size());
        scalePicture({drawn.data(), area}, zoom, part, into.data(), box);
        for (int y = 0; y < box.h; ++y)
            for (int x = 0; x < box.w; ++x)
                ASSERT_EQ(at(into, box, x, y), part.contains({box.x + x, box.y + y, 1, 1}) ? at(whole, box, x, y) : 0)
                    << x << "," << y << " by " << zoom.x;
    }
}

TEST(ScalePicture, keepsBrightness) {
    for (const Zoom zoom : {Zoom{1.5, 1.5}, Zoom{2.7, 0.6}, Zoom{0.3, 7.9}, Zoom{16, 1.01}, Zoom{1.999, 15.5}}) {
        RenderPass pass;
        pass.zoom = zoom;
        const PixelViewport box{7, 11, 24, 18}, area = inPass(pass, box);
        for (const int value : {0, 1, 127, 255}) {
            const auto shown = scaled(picture(area, [&](int, int) { return value; }), area, zoom, box);
            for (const std::byte b : shown) ASSERT_EQ(std::to_integer<int>(b), value) << zoom.x << " " << zoom.y;
        }
        const auto noise = picture(area, [](int x, int y) { return (x * 73 + y * 151 + x * y * 29) & 255; });
        const auto mean = [](const std::vector<std::byte>& bytes) {
            return std::accumulate(bytes.begin(), bytes.end(), 0.0,
                                   [](double sum, std::byte b) { return sum + std::to_integer<int>(b); }) /
                   static_cast<double>(bytes.size());
        };
        if (zoom.x > 1 && zoom.y > 1) {
            EXPECT_NEAR(mean(scaled(noise, area, zoom, box)), mean(noise), 3) << zoom.x << " " << zoom.y;
        }
    }
}

} // namespace
} // namespace mural
