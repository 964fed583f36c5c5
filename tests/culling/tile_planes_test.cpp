#include "nodes/culling/tile_planes.hpp"

#include <gtest/gtest.h>

#include "tests/culling/random_views.hpp"

namespace mural::culling {
namespace {

constexpr ClipWindow kWindow{0, 0, 640, 480};

LinearView identity() {
    const float one[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    return fixedFunctionView(one, one, 3);
}

Place placeOf(const TilePlanes& planes, std::array<float, 3> lowest, std::array<float, 3> highest) {
    return planes.placeOf(lowest.data(), highest.data());
}

TEST(TilePlanes, leaveOutABoxBesideTheArea) {
    const TilePlanes planes(identity(), kWindow, {0, 0, 320, 480}, 2);
    EXPECT_EQ(placeOf(planes, {0.1F, -1, 0}, {1, 1, 0}), Place::Outside);
    EXPECT_EQ(placeOf(planes, {-0.1F, -1, 0}, {1, 1, 0}), Place::Crossing);
    EXPECT_EQ(placeOf(planes, {-0.9F, -0.9F, 0}, {-0.1F, 0.9F, 0}), Place::Inside);
}

TEST(TilePlanes, keepABoxWithinTheMargin) {
    const TilePlanes planes(identity(), kWindow, {0, 0, 320, 480}, 4);
    EXPECT_EQ(placeOf(planes, {3.0F / 320, 0, 0}, {0.5F, 0.5F, 0}), Place::Crossing);
    EXPECT_EQ(placeOf(planes, {5.0F / 320, 0, 0}, {0.5F, 0.5F, 0}), Place::Outside);
}

TEST(TilePlanes, keepEverythingThatIsNotFinite) {
    float broken[16] = {};
    broken[0] = NAN;
    const float one[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const TilePlanes planes(fixedFunctionView(broken, one, 3), kWindow, {0, 0, 10, 10}, 2);
    EXPECT_EQ(placeOf(planes, {5, 5, 5}, {6, 6, 6}), Place::Crossing);
    const TilePlanes usable(identity(), kWindow, {0, 0, 10, 10}, 2);
    EXPECT_EQ(placeOf(usable, {NAN, NAN, NAN}, {NAN, NAN, NAN}), Place::Crossing);
    EXPECT_EQ(placeOf(usable, {INFINITY, 0, 0}, {INFINITY, 0, 0}), Place::Crossing);
    const TilePlanes empty(identity(), {0, 0, 0, 0}, {0, 0, 10, 10}, 2);
    EXPECT_EQ(placeOf(empty, {5, 5, 5}, {6, 6, 6}), Place::Crossing);
}

// A point of a box that is outside is beyond the area's edge by the margin, wherever w is positive.
TEST(TilePlanes, neverLeaveOutAVisiblePoint) {
    int outside = 0;
    for (unsigned seed = 0; seed < 4000; ++seed) {
        RandomView view(seed);
        const auto x = static_cast<int32_t>(view.between(0, 600)), y = static_cast<int32_t>(view.between(0, 440));
        const PixelViewport area{x, y, 40, 40};
        const TilePlanes planes(fixedFunctionView(view.projection, view.modelview, 3), kWindow, area, 1);
        std::array<float, 3> lowest{}, highest{};
        for (size_t i = 0; i < 3; ++i) {
            lowest[i] = view.between(-20, 20);
            highest[i] = lowest[i] + view.between(0, 10);
        }
        const Place place = placeOf(planes, lowest, highest);
        outside += place == Place::Outside;
        for (int point = 0; point < 50; ++point) {
            float position[3];
            for (size_t i = 0; i < 3; ++i) position[i] = view.between(lowest[i], highest[i]);
            const auto [cx, cy, w] = view.clip(position);
            if (w <= 0) continue;
            const double px = (double{cx} / w + 1) * 320, py = (double{cy} / w + 1) * 240;
            const bool isInArea = px > area.x && px < area.right() && py > area.y && py < area.top();
            ASSERT_FALSE(isInArea && place == Place::Outside) << "seed " << seed;
            // Within the margin, which a box inside may reach.
            const bool isNear =
                px > area.x - 1.5 && px < area.right() + 1.5 && py > area.y - 1.5 && py < area.top() + 1.5;
            ASSERT_FALSE(!isNear && place == Place::Inside) << "seed " << seed;
        }
    }
    EXPECT_GT(outside, 1000);
}

} // namespace
} // namespace mural::culling
