// The wire format of areas and zooms.
#include "nodes/session/viewport_assignment.hpp"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

namespace mural {
namespace {

TEST(AreasOnTheWire, roundTrip) {
    const ViewportAssignment first{7, {{0, 0, 1. / 3, 1}, {1. / 3, 0, 2. / 3, 1}, {0, 0, 0, 0}}}, second{8, {}};
    auto bytes = bytesOf(first);
    EXPECT_EQ(bytes.size(), 8u + 3 * 40);
    const auto more = bytesOf(second);
    bytes.insert(bytes.end(), more.begin(), more.end());
    std::span<const std::byte> rest(bytes);
    EXPECT_EQ(takeAreas(rest), first);
    EXPECT_EQ(takeAreas(rest), second);
    EXPECT_TRUE(rest.empty());
    EXPECT_FALSE(takeAreas(rest).has_value());
}

TEST(AreasOnTheWire, haveAZoomPerNode) {
    const auto back = [](const std::vector<double>& zooms) {
        const auto bytes = bytesOf(ViewportAssignment{1, {{0, 0, 1, 1}, {0, 0, 1, 1}}, zooms});
        std::span<const std::byte> rest(bytes);
        return takeAreas(rest);
    };
    EXPECT_EQ(back({.25, 1})->zooms, (std::vector<double>{.25, 1}));
    EXPECT_TRUE(back({1, 1})->zooms.empty());
    EXPECT_EQ(back({})->zoomOf(1), 1);
    for (const double wrong : {0., -1., 1.01, double(NAN), double(INFINITY)})
        EXPECT_FALSE(back({.5, wrong}).has_value()) << wrong;
}

TEST(AreasOnTheWire, areRejectedWhenInvalid) {
    const auto refused = [](const Viewport& v) {
        const auto bytes = bytesOf(ViewportAssignment{1, {v}});
        std::span<const std::byte> rest(bytes);
        return !takeAreas(rest) && rest.size() == bytes.size();
    };
    EXPECT_FALSE(refused({0, 0, 1, 1}));
    for (const Viewport& v : {Viewport{-0.1, 0, 1, 1},
                              {0, 0, 1.1, 1},
                              {0.5, 0, 0.6, 1},
                              {0, 0, 1, -1},
                              {NAN, 0, 1, 1},
                              {0, 0, INFINITY, 1}})
        EXPECT_TRUE(refused(v));
    auto bytes = bytesOf(ViewportAssignment{1, {{0, 0, 1, 1}}});
    for (size_t size = 0; size < bytes.size(); ++size) {
        std::span<const std::byte> part = std::span(bytes).first(size);
        EXPECT_FALSE(takeAreas(part).has_value()) << size;
    }
    const uint32_t many = UINT32_MAX;
    std::memcpy(bytes.data() + 4, &many, 4);
    std::span<const std::byte> rest(bytes);
    EXPECT_FALSE(takeAreas(rest).has_value());
}

} // namespace
} // namespace mural
