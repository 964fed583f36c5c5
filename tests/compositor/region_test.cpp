// Regions as sets of pixels, detection of the region of interest, and tile hashes.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "compositor/image/region_of_interest.hpp"
#include "compositor/image/tile_hash.hpp"

namespace mural::compositor {
namespace {

constexpr int32_t kSize = 40;

// The same set with one mark per pixel.
class Marks {
public:
    void set(const PixelViewport& area, bool to) {
        for (int32_t y = area.y; y < area.top(); ++y)
            for (int32_t x = area.x; x < area.right(); ++x) marks_[index(x, y)] = to;
    }
    [[nodiscard]] bool at(int32_t x, int32_t y) const { return marks_[index(x, y)]; }
    [[nodiscard]] int64_t area() const { return std::count(marks_.begin(), marks_.end(), true); }

private:
    static size_t index(int32_t x, int32_t y) { return static_cast<size_t>(y * kSize + x); }
    std::vector<bool> marks_ = std::vector<bool>(kSize * kSize);
};

void expectSame(const Region& region, const Marks& marks) {
    ASSERT_EQ(region.area(), marks.area()); // hence nothing overlaps
    for (int32_t y = 0; y < kSize; ++y)
        for (int32_t x = 0; x < kSize; ++x) ASSERT_EQ(region.contains(x, y), marks.at(x, y)) << x << "," << y;
}

PixelViewport randomArea(std::mt19937& random) {
    const auto x = static_cast<int32_t>(random() % kSize), y = static_cast<int32_t>(random() % kSize);
    return {x, y, 1 + static_cast<int32_t>(random() % static_cast<unsigned>(kSize - x)),
            1 + static_cast<int32_t>(random() % static_cast<unsigned>(kSize - y))};
}

TEST(Region, behavesAsASetOfPixels) {
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        Region region;
        Marks marks;
        for (int step = 0; step < 8; ++step) {
            const PixelViewport area = randomArea(random);
            const bool add = random() % 3 != 0;
            add ? region.add(area) : region.subtract(area);
            marks.set(area, add);
            if (random() % 4 == 0) region.simplify();
            expectSame(region, marks);
            EXPECT_TRUE(!add || region.covers(area));
        }
        const PixelViewport window = randomArea(random);
        Marks both;
        for (int32_t y = 0; y < kSize; ++y)
            for (int32_t x = 0; x < kSize; ++x)
                if (marks.at(x, y) && window.contains({x, y, 1, 1})) both.set({x, y, 1, 1}, true);
        expectSame(region.intersected(window), both);
        expectSame(region.intersected(Region(window)), both);
        const PixelViewport inside = region.intersected(window).bounds();
        EXPECT_TRUE(inside.empty() || region.bounds().contains(inside));
    }
}

TEST(Region, simplifiesTilesToRectangles) {
    Region region;
    for (int32_t y = 0; y < 4; ++y)
        for (int32_t x = 0; x < 5; ++x) region.add({x * 8, y * 8, 8, 8});
    region.simplify();
    ASSERT_EQ(region.rectangles().size(), 1u);
    EXPECT_EQ(region.bounds(), (PixelViewport{0, 0, 40, 32}));
}

TEST(RegionOfInterest, containsDrawnPixelsAndOmitsHoles) {
    std::mt19937 random(2);
    for (const PlaneFormat format :
         {PlaneFormat::Rgba8, PlaneFormat::D24S8, PlaneFormat::Rgba16F, PlaneFormat::Rgba32F}) {
        for (int round = 0; round < 40; ++round) {
            const auto width = static_cast<int32_t>(1 + random() % 150),
                       height = static_cast<int32_t>(1 + random() % 70);
            Background background;
            for (auto& b : background.pixel) b = std::byte{0x35};
            Plane plane(format, width, height);
            std::fill(plane.bytes().begin(), plane.bytes().end(), std::byte{0x35});
            const int32_t tile = round % 2 ? 16 : 7;
            std::vector<std::pair<int32_t, int32_t>> drawn;
            for (unsigned i = 0; i < random() % 6; ++i) {
                const auto x = static_cast<int32_t>(random() % static_cast<unsigned>(width)),
                           y = static_cast<int32_t>(random() % static_cast<unsigned>(height));
                const size_t pixel = bytesPerPixel(format);
                plane.view().row(y)[static_cast<size_t>(x) * pixel + pixel - 1] = std::byte{0x36};
                drawn.emplace_back(x, y);
            }
            const Region found = findRegionOfInterest(plane.view(), background, tile);
            int64_t tiles = 0;
            for (int32_t ty = 0; ty < height; ty += tile)
                for (int32_t tx = 0; tx < width; tx += tile) {
                    const PixelViewport area{tx, ty, std::min(tile, width - tx), std::min(tile, height - ty)};
                    const bool wanted = std::ranges::any_of(drawn, [&](auto& d) {
                        return area.contains({d.first, d.second, 1, 1});
                    });
                    EXPECT_EQ(found.covers(area), wanted);
                    tiles += wanted ? area.area() : 0;
                }
            EXPECT_EQ(found.area(), tiles) << "only tiles that hold something";
        }
    }
}

TEST(RegionOfInterest, ignoresStencilAndMergesTwoPlanes) {
    Plane depth(PlaneFormat::D24S8, 64, 16), colour(PlaneFormat::Rgba8, 64, 16);
    const Background far = Background::ofWord(0xffffff00), black = Background::ofWord(0);
    // any stencil
    for (size_t i = 0; i < depth.bytes().size(); ++i) depth.bytes()[i] = i % 4 ? std::byte{0xff} : std::byte(i);
    EXPECT_TRUE(findRegionOfInterest(depth.view(), far).empty());
    colour.view().row(3)[4 * 20] = std::byte{1};
    depth.view().row(3)[4 * 50 + 1] = std::byte{1};
    const Region both = findRegionOfInterest(colour.view(), black, depth.view(), far);
    EXPECT_EQ(both.area(), 2 * 16 * 16);
    EXPECT_TRUE(both.contains(20, 3) && both.contains(50, 3));
    EXPECT_FALSE(both.contains(0, 0) || both.contains(40, 3));
}

TEST(TileHash, ignoresStrideButNoByte) {
    std::mt19937 random(3);
    Plane plane(PlaneFormat::Rgba8, 50, 20);
    for (auto& b : plane.bytes()) b = static_cast<std::byte>(random());
    const PixelViewport area{7, 3, 31, 11};
    Plane tight(PlaneFormat::Rgba8, 31, 11);
    copyPlane(tight.view(), PlaneView(plane.view()).part(area));
    const TileHash hash = hashOf(PlaneView(plane.view()).part(area));
    EXPECT_EQ(hash, hashOf(tight.view()));
    for (size_t i = 0; i < tight.bytes().size(); i += 97) {
        tight.bytes()[i] ^= std::byte{1};
        EXPECT_NE(hash, hashOf(tight.view()));
        tight.bytes()[i] ^= std::byte{1};
    }
}

} // namespace
} // namespace mural::compositor
