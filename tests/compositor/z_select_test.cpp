// Depth compositing of areas: vector and scalar code agree for every depth function and format.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "compositor/image/pixel_bytes.hpp"
#include "compositor/kernels/z_select.hpp"
#include "tests/compositor/random_bytes.hpp"

namespace mural::compositor::test {
namespace {

constexpr size_t kCounts[] = {0, 1, 3, 4, 7, 15, 16, 17, 31, 33, 63, 64, 65, 127, 200};

uint32_t bits(float value) { return std::bit_cast<uint32_t>(value); }

// Few distinct depths, so ties are frequent.
std::vector<uint32_t> hardDepths(DepthFormat format) {
    if (format == DepthFormat::D24S8)
        return {0,          1,          0xff,       0x100,      0x101,      0x1ff,
                0x7fffff00, 0x80000000, 0x80000001, 0xffffff00, 0xffffffff, 0xfffffe00};
    const auto inf = std::numeric_limits<float>::infinity();
    return {bits(0.0f),  bits(-0.0f), bits(1.0f), bits(0.5f),  bits(std::nextafter(0.5f, 1.0f)),
            bits(-1.0f), bits(inf),   bits(-inf), 0x7fc00000,  0xffc00000,
            0x7f800001,  1,           0x80000001, bits(1e-30f)};
}

struct Pixels {
    std::vector<uint32_t> depth;
    std::vector<std::byte> colour;
    friend bool operator==(const Pixels&, const Pixels&) = default;
};

Pixels randomPixels(std::mt19937& random, DepthFormat format, size_t count, size_t colourBytes) {
    const std::vector<uint32_t> hard = hardDepths(format);
    Pixels p;
    for (size_t i = 0; i < count; ++i) p.depth.push_back(random() % 8 ? hard[random() % hard.size()] : random());
    p.colour = randomBytes(random, count * colourBytes);
    return p;
}

ZArea rowOf(Pixels& into, const Pixels& source, size_t colourBytes) {
    ZArea row;
    row.depth = into.depth.data();
    row.colour = into.colour.data();
    row.sourceDepth = source.depth.data();
    row.sourceColour = source.colour.data();
    row.colourBytes = colourBytes;
    row.columns = source.depth.size();
    return row;
}

std::vector<DepthRule> allRules() {
    std::vector<DepthRule> rules;
    for (int f = 0; f < kDepthFunctions; ++f)
        for (const DepthFormat format : {DepthFormat::D24S8, DepthFormat::D32F})
            for (const bool later : {false, true})
                for (const Coverage c : {Coverage::All, Coverage::NotClear, Coverage::Stencil}) {
                    if (c == Coverage::Stencil && format == DepthFormat::D32F) continue;
                    rules.push_back({static_cast<DepthFunction>(f), format, later, c,
                                     format == DepthFormat::D24S8 ? 0xffffff00u : bits(1.0f)});
                }
    return rules;
}

TEST(ZSelect, givesEqualResultsForVectorsAndPixels) {
    forEachTarget([](const char* target) {
        std::mt19937 random(1);
        for (const DepthRule& rule : allRules())
            for (const size_t colourBytes : {size_t{4}, size_t{8}, size_t{16}})
                for (const size_t count : kCounts) {
                    const Pixels source = randomPixels(random, rule.format, count, colourBytes);
                    Pixels into = randomPixels(random, rule.format, count, colourBytes);
                    Pixels expected = into;
                    zSelect(rowOf(into, source, colourBytes), rule);
                    zSelectScalar(rowOf(expected, source, colourBytes), rule);
                    ASSERT_EQ(into, expected) << target << " function " << static_cast<int>(rule.function) << " later "
                                              << rule.sourceIsLater << " count " << count;
                }
    });
}

// Rows with foreign data in between. In large areas fully won colours use streaming stores; rows start aligned and
// unaligned.
TEST(ZSelect, preservesDataBetweenRows) {
    struct Shape {
        size_t columns, rows, gap, begin;
    };
    constexpr Shape kShapes[] = {{1, 9, 3, 0},      {37, 20, 5, 1},    {64, 3, 0, 0},     {200, 11, 40, 2},
                                 {1024, 520, 0, 0}, {1021, 530, 3, 1}, {1024, 520, 16, 0}};
    forEachTarget([&](const char* target) {
        std::mt19937 random(3);
        for (const Shape& shape : kShapes)
            for (const size_t colourBytes : {size_t{4}, size_t{8}, size_t{0}}) {
                if (colourBytes != 4 && shape.rows > 100) continue; // only words use streaming stores
                const size_t stride = shape.columns + shape.gap, count = shape.begin + stride * shape.rows;
                using Words = std::vector<uint32_t, LineAligned<uint32_t>>;
                Words depth(count), sourceDepth(count);
                for (size_t i = 0; i < count; ++i) { // runs of pixels won by either side, and single ones
                    depth[i] = bits(0.5f);
                    sourceDepth[i] = bits(i / 150 % 3 == 0   ? 0.25f
                                          : i / 150 % 3 == 1 ? 0.75f
                                          : random() % 2     ? 0.25f
                                                             : 0.75f);
                }
                PixelBytes colour(count * colourBytes), sourceColour(count * colourBytes);
                fillRandomly(random, colour);
                fillRandomly(random, sourceColour);
                const auto areaOf = [&](Words& d, PixelBytes& c) {
                    ZArea area;
                    area.columns = shape.columns;
                    area.rows = shape.rows;
                    area.depth = d.data() + shape.begin;
                    area.sourceDepth = sourceDepth.data() + shape.begin;
                    area.depthStride = area.sourceDepthStride = static_cast<std::ptrdiff_t>(4 * stride);
                    if (colourBytes == 0) return area;
                    area.colourBytes = colourBytes;
                    area.colour = c.data() + shape.begin * colourBytes;
                    area.sourceColour = sourceColour.data() + shape.begin * colourBytes;
                    area.colourStride = area.sourceColourStride = static_cast<std::ptrdiff_t>(colourBytes * stride);
                    return area;
                };
                Words expectedDepth = depth;
                PixelBytes expectedColour = colour;
                const DepthRule rule{DepthFunction::Less, DepthFormat::D32F, true, Coverage::All, 0};
                for (size_t y = 0; y < shape.rows; ++y)
                    zSelectScalar(areaOf(expectedDepth, expectedColour).row(y), rule);
                zSelect(areaOf(depth, colour), rule);
                ASSERT_EQ(depth, expectedDepth) << target << " " << shape.columns << "x" << shape.rows;
                ASSERT_EQ(colour, expectedColour)
                    << target << " " << shape.columns << "x" << shape.rows << " of " << colourBytes << " bytes";
            }
    });
}

TEST(ZSelect, worksOnDepthWithoutColour) {
    std::vector<uint32_t> depth(40, bits(0.5f)), source(40, bits(0.25f));
    ZArea row;
    row.depth = depth.data();
    row.sourceDepth = source.data();
    row.columns = 40;
    zSelect(row, {DepthFunction::Less, DepthFormat::D32F, true, Coverage::All, 0});
    EXPECT_EQ(depth, source);
}

// Compares one pixel with another, independent of vectors; returns whether the source wins.
bool sourceWins(const DepthRule& rule, uint32_t source, uint32_t there) {
    Pixels a{{there}, std::vector<std::byte>(4, std::byte{1})}, b{{source}, std::vector<std::byte>(4, std::byte{2})};
    zSelect(rowOf(a, b, 4), rule);
    return a.colour[0] == std::byte{2};
}

TEST(ZSelect, resolvesTiesByDrawOrder) {
    for (const DepthFormat format : {DepthFormat::D24S8, DepthFormat::D32F}) {
        const uint32_t half = format == DepthFormat::D24S8 ? 0x80000000u : bits(0.5f);
        for (const auto& [function, laterWins] : {std::pair{DepthFunction::Less, false},
                                                  {DepthFunction::LessOrEqual, true},
                                                  {DepthFunction::Greater, false},
                                                  {DepthFunction::GreaterOrEqual, true}}) {
            EXPECT_EQ(sourceWins({function, format, true, Coverage::All, 0}, half, half), laterWins);
            EXPECT_EQ(sourceWins({function, format, false, Coverage::All, 0}, half, half), !laterWins);
        }
    }
}

TEST(ZSelect, ignoresStencilBits) {
    const DepthRule less{DepthFunction::Less, DepthFormat::D24S8, true, Coverage::All, 0};
    EXPECT_FALSE(sourceWins(less, 0x12345600, 0x123456ff)); // smaller as a word
    const DepthRule lessOrEqual{DepthFunction::LessOrEqual, DepthFormat::D24S8, true, Coverage::All, 0};
    EXPECT_TRUE(sourceWins(lessOrEqual, 0x123456ff, 0x12345600));
    EXPECT_TRUE(sourceWins(less, 0x123455ff, 0x12345600));
    const DepthRule greater{DepthFunction::Greater, DepthFormat::D24S8, true, Coverage::All, 0};
    EXPECT_FALSE(sourceWins(greater, 0x123456ff, 0x12345600));
}

TEST(ZSelect, makesNanLoseAndMinusZeroEqualZero) {
    const uint32_t nan = 0x7fc00000, other = 0xffc00001;
    for (const DepthFunction f :
         {DepthFunction::Less, DepthFunction::LessOrEqual, DepthFunction::Greater, DepthFunction::GreaterOrEqual})
        for (const bool later : {false, true}) {
            const DepthRule rule{f, DepthFormat::D32F, later, Coverage::All, 0};
            for (const float number :
                 {0.0f, 1.0f, -1.0f, std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
                EXPECT_FALSE(sourceWins(rule, nan, bits(number)));
                EXPECT_TRUE(sourceWins(rule, bits(number), nan));
            }
            EXPECT_EQ(sourceWins(rule, nan, other), !later); // the earlier one stays
        }
    EXPECT_FALSE(sourceWins({DepthFunction::Less, DepthFormat::D32F, true, Coverage::All, 0}, bits(-0.0f), bits(0.0f)));
    EXPECT_TRUE(
        sourceWins({DepthFunction::LessOrEqual, DepthFormat::D32F, true, Coverage::All, 0}, bits(0.0f), bits(-0.0f)));
}

TEST(ZSelect, makesUndrawnPixelsLose) {
    const uint32_t far24 = 0xffffff00;
    const DepthRule clear{DepthFunction::LessOrEqual, DepthFormat::D24S8, true, Coverage::NotClear, far24};
    EXPECT_FALSE(sourceWins(clear, far24, far24));
    EXPECT_FALSE(
        sourceWins({DepthFunction::Always, DepthFormat::D24S8, true, Coverage::NotClear, far24}, far24, 0x100));
    // A sky drawn at the clear depth, marked in the stencil.
    const DepthRule stencil{DepthFunction::LessOrEqual, DepthFormat::D24S8, true, Coverage::Stencil, 0};
    EXPECT_TRUE(sourceWins(stencil, far24 | 1, far24));
    EXPECT_FALSE(sourceWins(stencil, far24, far24 | 1));
}

// Undrawn pixels are equal in all parts.
void clearUndrawn(Pixels& p, const DepthRule& rule) {
    for (size_t i = 0; i < p.depth.size(); ++i) {
        const bool drawn = rule.coverage == Coverage::All ||
                           (rule.coverage == Coverage::Stencil  ? (p.depth[i] & 0xff) != 0
                            : rule.format == DepthFormat::D24S8 ? p.depth[i] >> 8 != rule.clearBits >> 8
                                                                : p.depth[i] != rule.clearBits);
        if (drawn) continue;
        p.depth[i] = rule.clearBits;
        std::fill_n(p.colour.begin() + static_cast<ptrdiff_t>(4 * i), 4, std::byte{0});
    }
}

// All ways to pair neighbours give one result; for order functions it equals drawing in sequence.
TEST(ZSelect, isIndependentOfPairing) {
    std::mt19937 random(7);
    for (const DepthRule& base : allRules()) {
        if (!decomposable(base.function)) continue;
        std::vector<Pixels> parts;
        for (int i = 0; i < 4; ++i) {
            parts.push_back(randomPixels(random, base.format, 333, 4));
            clearUndrawn(parts.back(), base);
        }
        const auto merge = [&](Pixels earlier, const Pixels& later, bool intoEarlier) {
            DepthRule rule = base;
            rule.sourceIsLater = intoEarlier;
            Pixels into = intoEarlier ? earlier : later;
            zSelect(rowOf(into, intoEarlier ? later : earlier, 4), rule);
            return into;
        };
        const Pixels inOrder = merge(merge(merge(parts[0], parts[1], true), parts[2], true), parts[3], true);
        for (const bool way : {false, true}) {
            EXPECT_EQ(merge(merge(parts[0], parts[1], way), merge(parts[2], parts[3], !way), way), inOrder)
                << static_cast<int>(base.function);
            EXPECT_EQ(merge(parts[0], merge(parts[1], merge(parts[2], parts[3], way), way), way), inOrder)
                << static_cast<int>(base.function);
            EXPECT_EQ(merge(merge(parts[0], merge(parts[1], parts[2], way), !way), parts[3], !way), inOrder)
                << static_cast<int>(base.function);
        }
    }
}

} // namespace
} // namespace mural::compositor::test
