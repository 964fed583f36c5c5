// Assembly of pictures: by depth, by blending, side by side, interleaved and masked.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "compositor/assembly/assembly.hpp"
#include "tests/compositor/random_bytes.hpp"

namespace mural::compositor::test {
namespace {

constexpr int32_t kWidth = 61, kHeight = 23;

Image emptyImage(PlaneFormat colour, DrawOrder order) {
    Image image;
    image.colour.emplace(colour, kWidth, kHeight);
    image.depth.emplace(PlaneFormat::D24S8, kWidth, kHeight);
    image.drawn.add(image.area());
    image.order = order;
    return image;
}

Image randomImage(std::mt19937& random, DrawOrder order) {
    Image image = emptyImage(PlaneFormat::Rgba8, order);
    fillRandomly(random, image.colour->bytes());
    for (auto& b : image.depth->bytes()) b = static_cast<std::byte>(random() % 2 ? 0x80 : 0x81); // many ties
    return image;
}

TEST(AssembleDepth, isIndependentOfArrivalOrder) {
    std::mt19937 random(1);
    std::array<Image, 3> parts{randomImage(random, {0, 1}), randomImage(random, {1, 2}), randomImage(random, {2, 3})};
    for (const DepthFunction f :
         {DepthFunction::Less, DepthFunction::LessOrEqual, DepthFunction::GreaterOrEqual, DepthFunction::Always}) {
        const auto merge = [&](std::array<size_t, 3> arrival) {
            Image sum = parts[arrival[0]];
            EXPECT_TRUE(assembleDepth(sum, parts[arrival[1]], {f, Coverage::All, 0}));
            EXPECT_TRUE(assembleDepth(sum, parts[arrival[2]], {f, Coverage::All, 0}));
            EXPECT_EQ(sum.order, (DrawOrder{0, 3}));
            return sum;
        };
        const Image inOrder = merge({0, 1, 2});
        for (const auto& arrival : {std::array<size_t, 3>{1, 0, 2}, {1, 2, 0}, {2, 1, 0}}) {
            const Image other = merge(arrival);
            EXPECT_EQ(other.colour, inOrder.colour);
            EXPECT_EQ(other.depth, inOrder.depth);
        }
        // 0 and 2 could be combined, but ties with 1 could then not be resolved.
        Image gap = parts[0];
        ASSERT_TRUE(assembleDepth(gap, parts[2], {f, Coverage::All, 0}));
        EXPECT_FALSE(assembleDepth(gap, parts[1], {f, Coverage::All, 0}));
    }
}

TEST(AssembleBlended, blendsOnlyNeighboursWithTheLaterInFront) {
    Image back = emptyImage(PlaneFormat::Rgba8, {0, 1}), front = emptyImage(PlaneFormat::Rgba8, {1, 2}),
          third = emptyImage(PlaneFormat::Rgba8, {2, 3});
    std::ranges::fill(back.colour->bytes(), std::byte{255});
    for (size_t i = 0; i < front.colour->bytes().size(); ++i)
        front.colour->bytes()[i] = std::byte(i % 4 == 3 ? 255 : 7);
    Image a = back, b = front;
    EXPECT_FALSE(assembleBlended(a, third)) << "something is missing in between";
    EXPECT_EQ(a.colour, back.colour);
    ASSERT_TRUE(assembleBlended(a, front));
    ASSERT_TRUE(assembleBlended(b, back));
    EXPECT_EQ(a.colour, front.colour);
    EXPECT_EQ(b.colour, front.colour);
    EXPECT_EQ(b.order, (DrawOrder{0, 2}));
}

TEST(AssembleCopy, placesParts) {
    std::mt19937 random(2);
    Image whole = emptyImage(PlaneFormat::Rgba8, {});
    const Image wanted = randomImage(random, {});
    whole.drawn = {};
    for (int32_t x = 0; x < kWidth; x += 20) {
        Image part;
        part.x = x;
        part.colour.emplace(PlaneFormat::Rgba8, std::min(20, kWidth - x), kHeight);
        part.drawn.add({0, 0, part.width(), kHeight});
        copyPlane(part.colour->view(), wanted.colour->view().part({x, 0, part.width(), kHeight}));
        ASSERT_TRUE(assembleCopy(whole, part));
    }
    EXPECT_EQ(whole.colour, wanted.colour);
    EXPECT_EQ(whole.drawn.rectangles().size(), 1u);
    Image outside = wanted;
    outside.y = 1;
    EXPECT_FALSE(assembleCopy(whole, outside));
    outside.drawn = Region({0, 0, kWidth, kHeight - 1});
    EXPECT_TRUE(assembleCopy(whole, outside)) << "what is not drawn may lie outside";
}

TEST(AssembleDepth, takesOnlyDrawnPixels) {
    std::mt19937 random(3);
    Image into = randomImage(random, {0, 1}), part = randomImage(random, {1, 2});
    const Image before = into;
    const PixelViewport hole{10, 5, 30, 9};
    part.drawn.subtract(hole);
    ASSERT_TRUE(assembleDepth(into, part, {DepthFunction::Always, Coverage::All, 0}));
    for (int32_t y = 0; y < kHeight; ++y)
        for (int32_t x = 0; x < kWidth; ++x) {
            const Image& from = hole.contains({x, y, 1, 1}) ? before : part;
            ASSERT_EQ(std::memcmp(into.colour->view().row(y) + 4 * x, from.colour->view().row(y) + 4 * x, 4), 0);
        }
    part.depth.reset();
    EXPECT_FALSE(assembleDepth(into, part, {}));
}

TEST(InterleavePixels, supportsSizesThatDoNotDivide) {
    std::mt19937 random(4);
    for (const PlaneFormat format : {PlaneFormat::Rgba8, PlaneFormat::Rgba16F, PlaneFormat::Rgba32F})
        for (const auto& [columns, rows] : {std::pair{1, 1}, {2, 1}, {1, 2}, {3, 2}, {4, 4}, {7, 5}})
            for (const auto& [width, height] : {std::pair{61, 23}, {1, 1}, {6, 4}, {5, 9}}) {
                Plane whole(format, width, height), put(format, width, height);
                fillRandomly(random, whole.bytes());
                for (int32_t row = rows - 1; row >= 0; --row)
                    for (int32_t column = 0; column < columns; ++column) {
                        const PixelKernel k{column, row, columns, rows};
                        const int32_t partWidth = column < width ? (width - column + columns - 1) / columns : 0,
                                      partHeight = row < height ? (height - row + rows - 1) / rows : 0;
                        // With exactly its pixels, or with an additional column and row outside the picture.
                        for (const PixelViewport& size :
                             {PixelViewport{0, 0, partWidth, partHeight}, apply({0, 0, width, height}, k)}) {
                            Plane part(format, size.w, size.h);
                            ASSERT_TRUE(deinterleavePixels(part.view(), whole.view(), k));
                            for (int32_t y = 0; y < partHeight; ++y)
                                for (int32_t x = 0; x < partWidth; ++x)
                                    ASSERT_EQ(std::memcmp(
                                                  part.view().row(y) + static_cast<size_t>(x) * bytesPerPixel(format),
                                                  whole.view().row(row + y * rows) +
                                                      static_cast<size_t>(column + x * columns) * bytesPerPixel(format),
                                                  bytesPerPixel(format)),
                                              0);
                            ASSERT_TRUE(interleavePixels(put.view(), part.view(), k));
                        }
                    }
                ASSERT_EQ(put, whole) << columns << "x" << rows << " of " << width << "x" << height;
            }
    Plane whole(PlaneFormat::Rgba8, 5, 5), two(PlaneFormat::Rgba8, 2, 5), four(PlaneFormat::Rgba8, 4, 5);
    EXPECT_FALSE(interleavePixels(whole.view(), two.view(), {0, 0, 2, 1})) << "that part has 3 columns";
    EXPECT_TRUE(interleavePixels(whole.view(), two.view(), {1, 0, 2, 1}));
    EXPECT_FALSE(interleavePixels(whole.view(), four.view(), {1, 0, 2, 1})) << "and this is too many";
    EXPECT_FALSE(interleavePixels(whole.view(), two.view(), {2, 0, 2, 1}));
}

TEST(AssembleMasked, masksComponentsOfEveryFormat) {
    std::mt19937 random(5);
    for (const auto& [format, bits] :
         {std::pair{PlaneFormat::Rgba8, 8}, {PlaneFormat::Rgba16F, 16}, {PlaneFormat::Rgba32F, 32}}) {
        Plane left(format, 37, 3), right(format, 37, 3);
        fillRandomly(random, left.bytes());
        fillRandomly(random, right.bytes());
        Plane both = left;
        ASSERT_TRUE(assembleMasked(both.view(), right.view(), {false, true, true, false}));
        for (size_t i = 0; i < both.bytes().size(); ++i) {
            const size_t component = i / (static_cast<size_t>(bits) / 8) % 4;
            ASSERT_EQ(both.bytes()[i], (component == 1 || component == 2 ? right : left).bytes()[i]);
        }
    }
    Plane left(PlaneFormat::Rgb10A2, 1, 1), right(PlaneFormat::Rgb10A2, 1, 1);
    std::ranges::fill(right.bytes(), std::byte{0xff});
    ASSERT_TRUE(assembleMasked(left.view(), right.view(), {true, false, false, true}));
    uint32_t word;
    std::memcpy(&word, left.bytes().data(), 4);
    EXPECT_EQ(word, 3u << 30 | 0x3ffu);
    Plane depth(PlaneFormat::D32F, 1, 1);
    EXPECT_FALSE(assembleMasked(left.view(), depth.view(), {}));
    EXPECT_FALSE(assembleMasked(depth.view(), depth.view(), {}));
}

} // namespace
} // namespace mural::compositor::test
