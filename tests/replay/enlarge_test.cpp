#include "nodes/replay/enlarge.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "nodes/replay/pass_place.hpp"

namespace mural {
namespace {

std::vector<std::byte> enlarged(const std::vector<std::byte>& small, const PixelViewport& area, double zoom, const PixelViewport& box) {
    std::vector<std::byte> into(static_cast<size_t>(box.area()) * 4);
    enlarge({small.data(), area}, {zoom, zoom}, box, into.data(), box);
    return into;
}

TEST(Enlarge, nothingChangesWithoutZoom) {
    std::vector<std::byte> small;
    for (int i = 0; i < 7 * 5 * 4; ++i) small.push_back(static_cast<std::byte>(i * 37));
    EXPECT_EQ(enlarged(small, {3, 2, 7, 5}, 1, {3, 2, 7, 5}), small);
}

// A ramp stays one: what lies between two middles is their mean by distance.
TEST(Enlarge, isLinearBetweenMiddles) {
    RenderPass pass;
    pass.zoom = {0.25, 0.25};
    const PixelViewport box{40, 0, 80, 8}, area = inPass(pass, box);
    ASSERT_EQ(area, (PixelViewport{10, 0, 20, 2}));
    std::vector<std::byte> small;
    for (int y = 0; y < area.h; ++y)
        for (int x = 0; x < area.w; ++x) small.insert(small.end(), 4, static_cast<std::byte>(8 * x));
    const auto large = enlarged(small, area, 0.25, box);
    for (int x = 2; x < box.w - 2; ++x) {
        const double wanted = 8 * ((x + 0.5) / 4 - 0.5);
        EXPECT_NEAR(std::to_integer<int>(large[static_cast<size_t>(x) * 4]), wanted, 0.51) << x;
    }
    EXPECT_EQ(large[0], small[0]) << "the outermost pixels count on";
    EXPECT_EQ(large.back(), small.back());
}

} // namespace
} // namespace mural
