// Sizes that fit no vector and no tile, and incompressible content: codecs and kernels compared bit by bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "compositor/assembly/assembly.hpp"
#include "compositor/codecs/registry.hpp"
#include "tests/numerics/case_table.hpp"

namespace mural::compositor {
namespace {

using numerics::expectWithin;

constexpr std::pair<int32_t, int32_t> kSizes[] = {{1, 1},  {1, 2047}, {2047, 1}, {3, 5},     {15, 3},
                                                  {17, 4}, {255, 63}, {257, 65}, {511, 129}, {1021, 67}};

Plane noise(PlaneFormat format, int32_t width, int32_t height) {
    std::mt19937 random(static_cast<unsigned>(width * 4099 + height));
    Plane plane(format, width, height);
    for (auto& b : plane.bytes()) b = static_cast<std::byte>(random());
    return plane;
}

TEST(Shapes, roundTripNoiseOfOddSizesThroughEveryCodec) {
    CodecRegistry registry;
    for (const PlaneFormat format : {PlaneFormat::Rgba8, PlaneFormat::Rgb10A2, PlaneFormat::Rgba16F,
                                     PlaneFormat::Rgba32F, PlaneFormat::D24S8, PlaneFormat::D32F})
        for (const auto& [width, height] : kSizes) {
            const Plane plane = noise(format, width, height);
            for (const CodecInfo& info : registry.losslessFor(format)) {
                auto made = registry.make(info.name);
                ASSERT_TRUE(made) << info.name;
                const std::unique_ptr<Codec>& codec = *made;
                std::vector<std::byte> bytes(codec->boundBytes(shapeOf(plane.view())) + 64, std::byte{0x5a});
                auto size = codec->encode(plane.view(), std::span(bytes).first(bytes.size() - 64));
                ASSERT_TRUE(size) << info.name;
                ASSERT_TRUE(
                    std::all_of(bytes.end() - 64, bytes.end(), [](std::byte b) { return b == std::byte{0x5a}; }))
                    << info.name << " wrote behind its bound";
                Plane back(format, width, height);
                ASSERT_TRUE(codec->decode(std::span(bytes).first(*size), back.view())) << info.name;
                size_t wrong = 0;
                for (size_t i = 0; i < back.bytes().size(); ++i) wrong += back.bytes()[i] != plane.bytes()[i];
                expectWithin("noise of 10 odd sizes in 6 formats by every lossless codec", "the bits",
                             static_cast<double>(wrong), 0, "bytes");
            }
            // Data that bit planes cannot compress stays raw: only tables and kinds of tiles are added.
            auto bitplane = registry.make("bitplane");
            ASSERT_TRUE(bitplane);
            std::vector<std::byte> bytes((*bitplane)->boundBytes(shapeOf(plane.view())));
            const size_t packed = (*bitplane)->encode(plane.view(), bytes).value();
            const size_t words = plane.bytes().size() / 4 / static_cast<size_t>(height);
            const auto tilesOf = [](size_t pixels, size_t by) { return (pixels + by - 1) / by; };
            expectWithin("what noise grows by, bit planes, for each tile", "5 bytes",
                         (static_cast<double>(packed) - static_cast<double>(plane.bytes().size())) /
                             static_cast<double>(tilesOf(words, 256) * tilesOf(static_cast<size_t>(height), 64)),
                         5, "bytes");
        }
}

// Divided into uneven tiles and kernels, and combined again.
TEST(Shapes, restoreNoiseOfOddSizesFromParts) {
    for (const auto& [width, height] : kSizes) {
        const Plane whole = noise(PlaneFormat::Rgba8, width, height);
        for (const auto& [w, h] : {std::pair(2, 1), std::pair(3, 2), std::pair(7, 5)}) {
            Plane joined(PlaneFormat::Rgba8, width, height);
            for (int32_t y = 0; y < h; ++y)
                for (int32_t x = 0; x < w; ++x) {
                    const PixelKernel kernel{x, y, w, h};
                    Plane part(PlaneFormat::Rgba8, (width + w - 1) / w, (height + h - 1) / h);
                    ASSERT_TRUE(deinterleavePixels(part.view(), whole.view(), kernel));
                    ASSERT_TRUE(interleavePixels(joined.view(), part.view(), kernel));
                }
            size_t wrong = 0;
            for (size_t i = 0; i < joined.bytes().size(); ++i) wrong += joined.bytes()[i] != whole.bytes()[i];
            expectWithin("noise of 10 odd sizes in kernels of 2x1, 3x2, 7x5", "the picture", static_cast<double>(wrong),
                         0, "bytes");
        }
    }
}

} // namespace
} // namespace mural::compositor
