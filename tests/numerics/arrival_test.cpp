// Pictures arrive in any order with the same result, which equals drawing everything in one piece.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <random>

#include "compositor/assembly/assembly.hpp"
#include "compositor/assembly/average.hpp"
#include "nodes/exchange/part_composition.hpp"

namespace mural::compositor {
namespace {

constexpr int32_t kWidth = 31, kHeight = 5;
constexpr size_t kPixels = size_t{kWidth} * kHeight;
constexpr uint32_t kFar = 0xffffff00; // D24S8: the largest depth

// A draw list: per pixel, the depths and colours drawn there in order. Few depth values, so ties are frequent.
struct Fragment {
    size_t pixel;
    uint32_t depth, colour;
};
using DrawList = std::vector<Fragment>;

DrawList randomList(std::mt19937& random, size_t count) {
    DrawList list;
    for (size_t i = 0; i < count; ++i)
        list.push_back({random() % kPixels, static_cast<uint32_t>(random() % 5) * 0x33333300u & 0xffffff00u,
                        0xff000000u | static_cast<uint32_t>(random() & 0xffffff)});
    return list;
}

bool passes(DepthFunction f, uint32_t later, uint32_t earlier) {
    switch (f) {
    case DepthFunction::Less: return later < earlier;
    case DepthFunction::LessOrEqual: return later <= earlier;
    case DepthFunction::Greater: return later > earlier;
    case DepthFunction::GreaterOrEqual: return later >= earlier;
    default: return false;
    }
}

struct Drawn {
    std::vector<uint32_t> colour, depth;
};

// OpenGL's depth test, fragment by fragment.
Drawn draw(const DrawList& list, size_t first, size_t end, DepthFunction f) {
    Drawn d{
        std::vector<uint32_t>(kPixels, 0),
        std::vector<uint32_t>(kPixels, f == DepthFunction::Greater || f == DepthFunction::GreaterOrEqual ? 0 : kFar)};
    for (size_t i = first; i < end; ++i)
        if (passes(f, list[i].depth, d.depth[list[i].pixel])) {
            d.depth[list[i].pixel] = list[i].depth;
            d.colour[list[i].pixel] = list[i].colour;
        }
    return d;
}

Image imageOf(const Drawn& d, uint32_t part) {
    Image image;
    image.colour.emplace(PlaneFormat::Rgba8, kWidth, kHeight);
    image.depth.emplace(PlaneFormat::D24S8, kWidth, kHeight);
    std::memcpy(image.colour->bytes().data(), d.colour.data(), 4 * kPixels);
    for (size_t i = 0; i < kPixels; ++i) { // the stencil marks drawn pixels, for draws at the clear depth
        const uint32_t word = d.depth[i] | (d.colour[i] != 0 ? 1 : 0);
        std::memcpy(image.depth->bytes().data() + 4 * i, &word, 4);
    }
    image.drawn.add(image.area());
    image.order = {part, part + 1};
    return image;
}

constexpr DepthFunction kShared[] = {DepthFunction::Less, DepthFunction::LessOrEqual, DepthFunction::Greater,
                                     DepthFunction::GreaterOrEqual};

// Uneven contiguous parts of the list, some of them empty.
std::vector<size_t> edgesOf(std::mt19937& random, size_t count, size_t parts) {
    std::vector<size_t> edges{0};
    for (size_t i = 1; i < parts; ++i) edges.push_back(random() % (count + 1));
    edges.push_back(count);
    std::ranges::sort(edges);
    return edges;
}

// Merges each arriving picture with an adjacent waiting one, until one picture is left.
Image assembled(std::vector<Image> arriving, DepthFunction f) {
    std::vector<Image> waiting;
    for (Image& next : arriving) {
        for (size_t i = 0; i < waiting.size();) {
            if (!adjacent(waiting[i].order, next.order)) {
                ++i;
                continue;
            }
            EXPECT_TRUE(assembleDepth(waiting[i], next, {f, Coverage::Stencil, 0}));
            next = std::move(waiting[i]);
            waiting.erase(waiting.begin() + static_cast<ptrdiff_t>(i));
            i = 0;
        }
        waiting.push_back(std::move(next));
    }
    EXPECT_EQ(waiting.size(), 1U);
    return std::move(waiting.front());
}

TEST(Arrival, givesOneSortLastPictureInAllOrders) {
    for (unsigned seed = 1; seed <= 3; ++seed)
        for (const DepthFunction f : kShared)
            for (size_t parts = 1; parts <= 6; ++parts) {
                std::mt19937 random(seed);
                const DrawList list = randomList(random, 900);
                const std::vector<size_t> edges = edgesOf(random, list.size(), parts);
                const Image wanted = imageOf(draw(list, 0, list.size(), f), 0);
                std::vector<size_t> order(parts);
                std::iota(order.begin(), order.end(), size_t{0});
                do {
                    std::vector<Image> arriving;
                    for (const size_t p : order)
                        arriving.push_back(imageOf(draw(list, edges[p], edges[p + 1], f), static_cast<uint32_t>(p)));
                    const Image got = assembled(std::move(arriving), f);
                    ASSERT_EQ(got.colour, wanted.colour)
                        << "seed " << seed << ", " << parts << " parts, function " << static_cast<int>(f);
                    ASSERT_EQ(got.depth, wanted.depth)
                        << "seed " << seed << ", " << parts << " parts, function " << static_cast<int>(f);
                } while (std::ranges::next_permutation(order).found);
            }
}

// The exchange of `mural run --db`, folded in rank order.
TEST(Arrival, givesOnePictureForRangesOfNodes) {
    for (unsigned seed = 1; seed <= 200; ++seed)
        for (const DepthFunction f : kShared) {
            std::mt19937 random(seed);
            const DrawList list = randomList(random, 600);
            const size_t parts = 1 + random() % 9;
            const std::vector<size_t> edges = edgesOf(random, list.size(), parts);
            const Drawn whole = draw(list, 0, list.size(), f), nothing = draw(list, 0, 0, f);
            for (const bool deep : {false, true}) { // with the kernel, and pixel by pixel
                const CompositeRule rule{f, nothing.colour[0], nothing.depth[0], deep};
                Drawn sum = draw(list, edges[0], edges[1], f);
                for (size_t p = 1; p < parts; ++p) {
                    const Drawn part = draw(list, edges[p], edges[p + 1], f);
                    compositeRow({sum.colour.data(), sum.depth.data(), part.colour.data(), part.depth.data(), kPixels},
                                 LayerOrder::Later, rule);
                }
                ASSERT_EQ(sum.colour, whole.colour)
                    << "seed " << seed << ", " << parts << " parts, function " << static_cast<int>(f);
                ASSERT_EQ(sum.depth, whole.depth) << "seed " << seed;
            }
        }
}

// Tiles, kernels and samples are disjoint: all 720 orders of six of them.
TEST(Arrival, givesOnePictureForTilesKernelsAndSamplesInAllOrders) {
    std::mt19937 random(9);
    Plane picture(PlaneFormat::Rgba8, kWidth, kHeight);
    for (auto& b : picture.bytes()) b = static_cast<std::byte>(random());
    std::array<size_t, 6> order{0, 1, 2, 3, 4, 5};
    Plane firstAverage;
    do {
        Image tiled;
        tiled.colour.emplace(PlaneFormat::Rgba8, kWidth, kHeight);
        Plane interleaved(PlaneFormat::Rgba8, kWidth, kHeight);
        Average average(PlaneFormat::Rgba8, kWidth, kHeight);
        for (const size_t i : order) {
            const auto k = static_cast<int32_t>(i);
            Image tile;
            tile.x = kWidth * k / 6;
            const int32_t width = kWidth * (k + 1) / 6 - tile.x;
            tile.colour.emplace(PlaneFormat::Rgba8, width, kHeight);
            copyPlane(tile.colour->view(), std::as_const(picture).view().part({tile.x, 0, width, kHeight}));
            tile.drawn.add({0, 0, width, kHeight});
            ASSERT_TRUE(assembleCopy(tiled, tile));
            const PixelKernel kernel{k % 3, k / 3, 3, 2};
            const PixelViewport columns = apply(PixelViewport{0, 0, kWidth, kHeight}, kernel);
            Plane part(PlaneFormat::Rgba8, columns.w, columns.h);
            ASSERT_TRUE(deinterleavePixels(part.view(), std::as_const(picture).view(), kernel));
            ASSERT_TRUE(interleavePixels(interleaved.view(), std::as_const(part).view(), kernel));
            Plane sample = picture;
            for (auto& b : sample.bytes()) b = static_cast<std::byte>(std::to_integer<unsigned>(b) * (i + 3) / 9);
            ASSERT_TRUE(average.add(std::as_const(sample).view()));
        }
        ASSERT_EQ(*tiled.colour, picture);
        ASSERT_EQ(interleaved, picture);
        Plane mean(PlaneFormat::Rgba8, kWidth, kHeight);
        ASSERT_TRUE(average.write(mean.view()));
        if (firstAverage.bytes().empty()) firstAverage = mean;
        ASSERT_EQ(mean, firstAverage);
    } while (std::ranges::next_permutation(order).found);
}

} // namespace
} // namespace mural::compositor
