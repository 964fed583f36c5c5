// Upper bounds of the errors of lossy codecs.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "compositor/codecs/registry.hpp"
#include "tests/numerics/case_table.hpp"

namespace mural::compositor {
namespace {

Plane through(const std::string& name, const Plane& plane) {
    CodecRegistry registry;
    auto codec = registry.make(name);
    EXPECT_TRUE(codec);
    std::vector<std::byte> bytes((*codec)->boundBytes(shapeOf(plane.view())));
    auto size = (*codec)->encode(plane.view(), bytes);
    EXPECT_TRUE(size);
    Plane back(plane.format(), plane.width(), plane.height());
    EXPECT_TRUE((*codec)->decode(std::span(bytes).first(*size), back.view()));
    return back;
}

struct Loss {
    int largest = 0;
    double meanSquare = 0;
};

Loss lossOf(const Plane& a, const Plane& b) {
    Loss loss;
    size_t count = 0;
    for (size_t i = 0; i < a.bytes().size(); ++i) {
        if (i % 4 == 3) continue;
        const int d = std::to_integer<int>(a.bytes()[i]) - std::to_integer<int>(b.bytes()[i]);
        loss.largest = std::max(loss.largest, std::abs(d));
        loss.meanSquare += d * d;
        ++count;
    }
    loss.meanSquare /= static_cast<double>(count);
    return loss;
}

// Uniform blocks: subsampling loses nothing, only the colour transform rounds. Every colour of a grid of 33 x 33 x 33,
// in blocks of 16 x 16, the size of JPEG's.
Plane blocksOfColours() {
    constexpr int kSteps = 33, kBlock = 16;
    Plane plane(PlaneFormat::Rgba8, kSteps * kBlock, kSteps * kSteps * kBlock);
    for (int32_t y = 0; y < plane.height(); ++y)
        for (int32_t x = 0; x < plane.width(); ++x) {
            std::byte* pixel = plane.view().row(y) + 4 * x;
            const int values[3] = {x / kBlock, y / kBlock % kSteps, y / kBlock / kSteps};
            for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::byte>(std::min(255, values[c] * 8));
            pixel[3] = std::byte{255};
        }
    return plane;
}

// Y, U and V are rounded to half a unit. For green that is .5 + .344 / 2 + .714 / 2, for blue .5 + 1.772 / 2, and the
// result is rounded once more: at most 1.9.
TEST(Lossy, preservesUniformColoursNearly) {
    const Plane colours = blocksOfColours();
    const Loss yuv = lossOf(colours, through("yuv420", colours));
    numerics::expectWithin("35937 colours that stay, YUV 4:2:0", "the colours", yuv.largest, 2, "of 255");
    EXPECT_GT(yuv.meanSquare, 0) << "nothing was lost: was it YUV?";
    const Loss jpeg = lossOf(colours, through("jpeg-100", colours));
    numerics::expectWithin("35937 colours that stay, JPEG 100", "the colours", jpeg.largest, 3, "of 255");
}

TEST(Lossy, preservesGreys) {
    Plane grey(PlaneFormat::Rgba8, 256, 16);
    for (int32_t y = 0; y < 16; ++y)
        for (int32_t x = 0; x < 256; ++x) std::memset(grey.view().row(y) + 4 * x, x, 4);
    numerics::expectWithin("greys, YUV 4:2:0", "the greys", lossOf(grey, through("yuv420", grey)).largest, 0, "of 255");
    numerics::expectWithin("greys, JPEG 100", "the greys", lossOf(grey, through("jpeg-100", grey)).largest, 1,
                           "of 255");
}

// Luma noise: YUV preserves it up to rounding, JPEG by its quality, and never worse at a higher quality.
TEST(Lossy, preservesLumaAndImprovesWithQuality) {
    std::mt19937 random(3);
    Plane noise(PlaneFormat::Rgba8, 256, 128);
    for (size_t i = 0; i < noise.bytes().size(); i += 4)
        std::memset(noise.bytes().data() + i, static_cast<int>(random() % 256), 4);
    EXPECT_LE(lossOf(noise, through("yuv420", noise)).largest, 0);
    double before = 1e9;
    for (const char* name : {"jpeg-50", "jpeg-80", "jpeg-95", "jpeg-100"}) {
        const double lost = lossOf(noise, through(name, noise)).meanSquare;
        EXPECT_LT(lost, before) << name;
        before = lost;
    }
    EXPECT_LT(before, 1); // 48 dB at quality 100
}

// Subsampling loses colour that changes with every pixel; luma must not suffer.
TEST(Lossy, preservesLumaOfSubsampledColour) {
    Plane stripes(PlaneFormat::Rgba8, 64, 64);
    for (int32_t y = 0; y < 64; ++y)
        for (int32_t x = 0; x < 64; ++x) {
            std::byte* pixel = stripes.view().row(y) + 4 * x;
            const int shift = x % 2 ? 30 : -30; // along a line of equal luma: .299 r + .587 g + .114 b
            pixel[0] = static_cast<std::byte>(128 + shift);
            pixel[1] = static_cast<std::byte>(128 - std::lround(shift * .299 / .587));
            pixel[2] = std::byte{128};
            pixel[3] = std::byte{255};
        }
    const Plane back = through("yuv420", stripes);
    numerics::expectWithin("stripes of colour, subsampled", "the stripes", lossOf(stripes, back).largest, 33, "of 255");
    const auto brightness = [](const std::byte* p) {
        return .299 * std::to_integer<int>(p[0]) + .587 * std::to_integer<int>(p[1]) +
               .114 * std::to_integer<int>(p[2]);
    };
    for (size_t i = 0; i < back.bytes().size(); i += 4)
        ASSERT_NEAR(brightness(back.bytes().data() + i), brightness(stripes.bytes().data() + i), 1.5);
}

} // namespace
} // namespace mural::compositor
