// Blending compared with double precision: many layers, emission brighter than its coverage, order and adjacency.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "compositor/assembly/assembly.hpp"
#include "compositor/kernels/blend_over.hpp"
#include "compositor/kernels/half_float.hpp"
#include "tests/numerics/case_table.hpp"

namespace mural::compositor {
namespace {

using numerics::expectThat;
using numerics::expectWithin;

constexpr size_t kBlendedPixels = 1021; // no multiple of any vector

struct Layers {
    std::vector<std::vector<double>> colours; // premultiplied, 0 to 255
};

Layers layersOf(int count, double minAlpha, double maxAlpha) {
    std::mt19937 random(static_cast<unsigned>(count));
    Layers layers;
    for (int i = 0; i < count; ++i) {
        std::vector<double> layer(4 * kBlendedPixels);
        for (size_t p = 0; p < layer.size(); p += 4) {
            const double alpha = std::round(255 * std::uniform_real_distribution<>(minAlpha, maxAlpha)(random));
            for (size_t c = 0; c < 3; ++c)
                layer[p + c] = std::round(std::uniform_real_distribution<>(0, alpha)(random));
            layer[p + 3] = alpha;
        }
        layers.colours.push_back(layer);
    }
    return layers;
}

std::vector<double> truthOf(const Layers& layers) {
    std::vector<double> sum(4 * kBlendedPixels, 0);
    for (const auto& front : layers.colours)
        for (size_t i = 0; i < sum.size(); ++i) sum[i] = front[i] + sum[i] * (255 - front[i / 4 * 4 + 3]) / 255;
    return sum;
}

// Blends n layers in halves of the list, as nodes would: each half separately, then one over the other.
double offBy(const Layers& layers, PlaneFormat format) {
    const bool halves = format == PlaneFormat::Rgba16F;
    const auto pack = [&](const std::vector<double>& layer) {
        Plane plane(format, kBlendedPixels, 1);
        for (size_t i = 0; i < layer.size(); ++i) {
            if (!halves)
                plane.bytes()[i] = static_cast<std::byte>(std::lround(layer[i]));
            else {
                const uint16_t h = halfOfFloat(static_cast<float>(layer[i] / 255));
                plane.bytes()[2 * i] = static_cast<std::byte>(h & 0xff);
                plane.bytes()[2 * i + 1] = static_cast<std::byte>(h >> 8);
            }
        }
        return plane;
    };
    const auto fold = [&](size_t first, size_t end) {
        Plane sum = pack(std::vector<double>(4 * kBlendedPixels, 0));
        for (size_t i = first; i < end; ++i)
            blendOverRow(format, sum.bytes().data(), pack(layers.colours[i]).bytes().data(), kBlendedPixels,
                         SourceSide::InFront);
        return sum;
    };
    Plane back = fold(0, layers.colours.size() / 2);
    const Plane front = fold(layers.colours.size() / 2, layers.colours.size());
    blendOverRow(format, back.bytes().data(), front.bytes().data(), kBlendedPixels, SourceSide::InFront);
    const std::vector<double> truth = truthOf(layers);
    double worst = 0;
    for (size_t i = 0; i < truth.size(); ++i) {
        const double got = halves ? 255.0 * static_cast<double>(floatOfHalf(static_cast<uint16_t>(
                                                std::to_integer<unsigned>(back.bytes()[2 * i]) |
                                                std::to_integer<unsigned>(back.bytes()[2 * i + 1]) << 8)))
                                  : static_cast<double>(std::to_integer<int>(back.bytes()[i]));
        worst = std::max(worst, std::abs(got - truth[i]));
    }
    return worst;
}

TEST(Blending, staysAccurateForManyLayers) {
    for (const int n : {1, 2, 8, 32, 64}) {
        expectWithin("1 to 64 layers over each other, RGBA8, alpha from 0.1", "double",
                     offBy(layersOf(n, .1, 1), PlaneFormat::Rgba8), 3, "of 255");
        expectWithin("1 to 64 layers over each other, RGBA16F", "double",
                     offBy(layersOf(n, .03, 1), PlaneFormat::Rgba16F), 1, "of 255");
    }
    for (const int n : {8, 64})
        expectWithin("8 and 64 thin layers, RGBA8, alpha 0.03", "double",
                     offBy(layersOf(n, .03, .03), PlaneFormat::Rgba8), 6, "of 255");
}

TEST(Blending, losesNothingWhenRepeated) {
    Plane whole(PlaneFormat::Rgba8, kBlendedPixels, 1), clear(PlaneFormat::Rgba8, kBlendedPixels, 1);
    std::ranges::fill(whole.bytes(), std::byte{255});
    for (int i = 0; i < 1000; ++i) {
        blendOverRow(PlaneFormat::Rgba8, whole.bytes().data(), clear.bytes().data(), kBlendedPixels,
                     SourceSide::InFront);
        blendOverRow(PlaneFormat::Rgba8, whole.bytes().data(), clear.bytes().data(), kBlendedPixels,
                     SourceSide::Behind);
    }
    expectWithin("white under 1000 transparent layers (by >> 8: 239 after 16)", "white",
                 255 - std::to_integer<int>(*std::ranges::min_element(whole.bytes())), 0, "of 255");
}

// All 2^24 combinations of background, emission and alpha. Emission may exceed the coverage; the sum then saturates
// instead of wrapping.
TEST(Blending, saturates) {
    double worst = 0;
    for (int alpha = 0; alpha < 256; ++alpha)
        for (int light = 0; light < 256; ++light) {
            // 256 components: red, green, blue of 64 pixels are backgrounds, alpha is alpha
            Plane sum(PlaneFormat::Rgba8, 64, 1), over = sum;
            for (int i = 0; i < 256; ++i) {
                const bool isAlpha = i % 4 == 3;
                sum.bytes()[static_cast<size_t>(i)] = static_cast<std::byte>(i);
                over.bytes()[static_cast<size_t>(i)] = static_cast<std::byte>(isAlpha ? alpha : light);
            }
            blendOverRow(PlaneFormat::Rgba8, sum.bytes().data(), over.bytes().data(), 64, SourceSide::InFront);
            for (int i = 0; i < 256; ++i) {
                const double exact = std::min(255.0, (i % 4 == 3 ? alpha : light) + i * (255 - alpha) / 255.0);
                worst = std::max(worst, std::abs(std::to_integer<int>(sum.bytes()[static_cast<size_t>(i)]) - exact));
            }
        }
    expectWithin("light brighter than it covers, all backgrounds, lights and alphas", "double, saturated", worst, 0.5,
                 "of 255");
}

Image layerImage(const Layers& layers, uint32_t i) {
    Image image;
    image.colour.emplace(PlaneFormat::Rgba8, static_cast<int32_t>(kBlendedPixels), 1);
    for (size_t b = 0; b < 4 * kBlendedPixels; ++b)
        image.colour->bytes()[b] = static_cast<std::byte>(std::lround(layers.colours[i][b]));
    image.drawn = Region(image.area());
    image.order = {i, i + 1};
    return image;
}

// Five layers arrive in each of 120 orders: non-adjacent layers wait, and the result is accurate in every order.
TEST(Blending, blendsOnlyNeighbours) {
    const Layers layers = layersOf(5, .1, 1);
    const std::vector<double> truth = truthOf(layers);
    std::array<uint32_t, 5> arrival{0, 1, 2, 3, 4};
    double worst = 0;
    int refused = 0, gaps = 0;
    do {
        std::vector<Image> waiting;
        for (const uint32_t i : arrival) {
            Image next = layerImage(layers, i);
            for (size_t w = 0; w < waiting.size();) {
                const bool neighbours = adjacent(waiting[w].order, next.order);
                gaps += !neighbours;
                Image joined = waiting[w];
                if (!assembleBlended(joined, next)) {
                    refused += !neighbours;
                    EXPECT_FALSE(neighbours);
                    ++w;
                    continue;
                }
                EXPECT_TRUE(neighbours);
                next = joined;
                waiting.erase(waiting.begin() + static_cast<ptrdiff_t>(w));
                w = 0;
            }
            waiting.push_back(next);
        }
        ASSERT_EQ(waiting.size(), 1U);
        for (size_t i = 0; i < truth.size(); ++i)
            worst = std::max(worst, std::abs(std::to_integer<int>(waiting[0].colour->bytes()[i]) - truth[i]));
    } while (std::ranges::next_permutation(arrival).found);
    expectWithin("5 layers in all 120 orders of arrival", "double", worst, 3, "of 255");
    expectThat("layers that are no neighbours", "their draw order", refused == gaps && gaps > 0,
               std::to_string(refused) + " of " + std::to_string(gaps) + " refused");
}

} // namespace
} // namespace mural::compositor
