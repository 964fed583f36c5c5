// Depth compositing compared with a single depth test, fragment by fragment: ties by function, stencil bits, NaN,
// reversed Z, and planes 10^10 apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "compositor/kernels/z_select.hpp"
#include "tests/numerics/case_table.hpp"

namespace mural::compositor {
namespace {

using numerics::expectThat;
using numerics::expectWithin;

constexpr size_t kComparedPixels = 4099;
constexpr DepthFunction kOrders[] = {DepthFunction::Less, DepthFunction::LessOrEqual, DepthFunction::Greater,
                                     DepthFunction::GreaterOrEqual};
constexpr const char* kNames[] = {"GL_LESS", "GL_LEQUAL", "GL_GREATER", "GL_GEQUAL"};

struct Part {
    std::vector<uint32_t> depth, colour;
};
using Maker = uint32_t (*)(std::mt19937&);

std::vector<Part> partsOf(Maker make, int count) {
    std::mt19937 random(5);
    std::vector<Part> parts(static_cast<size_t>(count));
    uint32_t number = 1;
    for (Part& p : parts)
        for (size_t i = 0; i < kComparedPixels; ++i) {
            p.depth.push_back(make(random));
            p.colour.push_back(number++); // every fragment has a unique colour
        }
    return parts;
}

// As doubles, which represent 24 bits and floats exactly. NaN loses against every number; of two NaNs the earlier one
// stays.
double valueOf(uint32_t word, DepthFormat format) {
    return format == DepthFormat::D24S8 ? word >> 8 : static_cast<double>(std::bit_cast<float>(word));
}
bool laterWins(DepthFunction f, double later, double earlier) {
    if (std::isnan(later) || std::isnan(earlier)) return !std::isnan(later);
    switch (f) {
    case DepthFunction::Less: return later < earlier;
    case DepthFunction::LessOrEqual: return later <= earlier;
    case DepthFunction::Greater: return later > earlier;
    default: return later >= earlier;
    }
}

// Folds in a tree of neighbours, from both sides. Returns the number of pixels that differ from drawing all in order.
size_t wrongPixels(const std::vector<Part>& drawn, DepthFunction function, DepthFormat format) {
    Part wanted = drawn[0];
    for (size_t p = 1; p < drawn.size(); ++p)
        for (size_t i = 0; i < kComparedPixels; ++i)
            if (laterWins(function, valueOf(drawn[p].depth[i], format), valueOf(wanted.depth[i], format))) {
                wanted.depth[i] = drawn[p].depth[i];
                wanted.colour[i] = drawn[p].colour[i];
            }
    std::vector<Part> parts = drawn;
    bool intoEarlier = true;
    while (parts.size() > 1) {
        std::vector<Part> next;
        for (size_t p = 0; p + 1 < parts.size(); p += 2, intoEarlier = !intoEarlier) {
            Part into = parts[intoEarlier ? p : p + 1];
            const Part& source = parts[intoEarlier ? p + 1 : p];
            zSelect({into.depth.data(), reinterpret_cast<std::byte*>(into.colour.data()), source.depth.data(),
                     reinterpret_cast<const std::byte*>(source.colour.data()), 4, kComparedPixels},
                    {function, format, intoEarlier, Coverage::All, 0});
            next.push_back(into);
        }
        if (parts.size() % 2) next.push_back(parts.back());
        parts = next;
    }
    size_t wrong = 0;
    for (size_t i = 0; i < kComparedPixels; ++i)
        wrong += parts[0].colour[i] != wanted.colour[i] || parts[0].depth[i] != wanted.depth[i];
    return wrong;
}

void expectExact(const std::string& what, Maker make, DepthFormat format, size_t firstFunction = 0) {
    for (const int count : {2, 3, 7, 16}) {
        const std::vector<Part> parts = partsOf(make, count);
        for (size_t f = firstFunction; f < std::size(kOrders); ++f)
            expectWithin(what + ", " + kNames[f], "the depth test in doubles, in draw order",
                         static_cast<double>(wrongPixels(parts, kOrders[f], format)), 0, "pixels");
    }
}

TEST(Depths, resolveTiesByTheFunction) {
    expectExact(
        "2 to 16 parts, ties everywhere, D24S8",
        [](std::mt19937& r) { return static_cast<uint32_t>(0x80000000U + (r() % 3 << 8)); }, DepthFormat::D24S8);
    expectExact(
        "2 to 16 parts, ties everywhere, D32F",
        [](std::mt19937& r) { return std::bit_cast<uint32_t>(0.5F) + static_cast<uint32_t>(r() % 3); },
        DepthFormat::D32F);
}

TEST(Depths, ignoreStencilBits) {
    expectExact(
        "stencil bits at random beside tied depths",
        [](std::mt19937& r) { return static_cast<uint32_t>(0x12345600U + (r() % 2 << 8) + r() % 256); },
        DepthFormat::D24S8);
}

TEST(Depths, makeNanLose) {
    expectExact(
        "NaN, -0, infinities, denormals among numbers, D32F",
        [](std::mt19937& r) {
            constexpr uint32_t kSpecial[] = {0,          0x80000000, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc00001,
                                             0x7f800001, 1,          0x80000001, 0x3f800000, 0xbf800000};
            return kSpecial[r() % std::size(kSpecial)];
        },
        DepthFormat::D32F);
}

// Near and far plane 10^10 apart in floats: reversed Z uses nearly all floats between 0 and 1; normal Z puts nearly
// everything into the last steps below 1.
TEST(Depths, supportPlanesTenToTheTenApart) {
    const auto reversed = [](std::mt19937& r) {
        const double z = std::pow(10, std::uniform_real_distribution<>(-4, 6)(r)), nearPlane = 1e-4, farPlane = 1e6;
        return std::bit_cast<uint32_t>(static_cast<float>(nearPlane * (farPlane - z) / (z * (farPlane - nearPlane))));
    };
    expectExact("reversed Z, near plane 10^-4, far plane 10^6, D32F", reversed, DepthFormat::D32F, 2);
    const auto usual = [](std::mt19937& r) {
        const double z = std::pow(10, std::uniform_real_distribution<>(-4, 6)(r)), nearPlane = 1e-4, farPlane = 1e6;
        return static_cast<uint32_t>(std::lround(farPlane * (z - nearPlane) / (z * (farPlane - nearPlane)) * 0xffffff))
               << 8;
    };
    expectExact("near plane 10^-4, far plane 10^6, D24S8", usual, DepthFormat::D24S8);
}

// Equal and NotEqual depend on other parts' depth: no order of folding gives the result, so they are not decomposed.
TEST(Depths, rejectFunctionsThatCannotBeDecomposed) {
    const bool refused = !decomposable(DepthFunction::Equal) && !decomposable(DepthFunction::NotEqual);
    expectThat("GL_EQUAL, GL_NOTEQUAL", "what others have drawn", refused, "not shared");
}

} // namespace
} // namespace mural::compositor
