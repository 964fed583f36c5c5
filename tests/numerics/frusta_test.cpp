// The position of a vertex in a part's frustum relative to the whole picture: in pixels, with wider arithmetic.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "balancer/compound/even_split.hpp"
#include "balancer/compound/plan_frame.hpp"
#include "balancer/config/resolve.hpp"
#include "balancer/config/eqc/parser.hpp"
#include "tests/numerics/case_table.hpp"
#include "tests/numerics/planned.hpp"

namespace mural::compound {
namespace {

using Exact = long double; // 64-bit mantissa; double has 53
static_assert(std::numeric_limits<Exact>::digits >= 64);

// One picture of width × height, divided by the given parts of one compound, each drawn by channel s; both eyes.
Planned planned(int width, int height, const std::string& parts) {
    const std::string window =
        "window { viewport [ 0 0 " + std::to_string(width) + " " + std::to_string(height) + " ] ";
    const std::string text =
        "#Equalizer 1.2 ascii\nconfig { appNode { pipe { " + window + "channel { name \"d\" } } " + window +
        "channel { name \"s\" } } } } "
        "observer { eye_base .065 } layout { view { observer 0 mode STEREO } } canvas { layout 0 wall { bottom_left [ "
        "-.83 -.47 -1.1 ] bottom_right [ .91 -.47 -1.1 ] top_left [ -.83 .52 -1.1 ] } segment { channel \"d\" } } "
        "compound { channel ( ) " +
        parts + " } }";
    config::Diagnostics diagnostics("f");
    Planned p{config::resolve(config::parseConfig(text, diagnostics), {}, diagnostics), {}};
    EXPECT_EQ(diagnostics.errors(), 0) << diagnostics.firstError();
    FrameInput input = firstFrame(p.config);
    input.views.assign(p.config.views.size(), ViewState{config::ViewMode::Stereo, 1, {}});
    p.plan = planFrame(p.config, input);
    return p;
}

// For a frustum that `pixels` pixels show: the pixel, counted from its first, of a place on the near plane.
template <class Real> Real pixelOf(double left, double right, Real place, int pixels) {
    return (place - static_cast<Real>(left)) / (static_cast<Real>(right) - static_cast<Real>(left)) *
           static_cast<Real>(pixels);
}

// As OpenGL computes it: glFrustum's matrix, w and the viewport transform in floats.
float pixelByFloats(double left, double right, double nearPlane, float x, float z, int pixels) {
    const auto scale = static_cast<float>(2 * nearPlane / (right - left)),
               shear = static_cast<float>((right + left) / (right - left));
    const float clip = scale * x + shear * z, w = -z, half = static_cast<float>(pixels) / 2;
    return clip / w * half + half;
}

// The maximum error of vertices along one axis.
struct Off {
    double byDoubles = 0; // of the frustum itself
    double byFloats = 0;  // with OpenGL's floats
};

void measure(std::mt19937& random, const Frustum& whole, const Frustum& part, bool horizontal, int wholePixels,
             int partPixels, const PixelAxis& axis, Off& off) {
    const double l = horizontal ? whole.left : whole.bottom, r = horizontal ? whole.right : whole.top;
    const double pl = horizontal ? part.left : part.bottom, pr = horizontal ? part.right : part.top;
    for (int i = 0; i < 50; ++i) {
        const double inside = std::uniform_real_distribution<>(0, 1)(random);
        const auto z = static_cast<float>(-std::exp(std::uniform_real_distribution<>(-2, 9)(random)));
        const auto x = static_cast<float>((pl + inside * (pr - pl)) * -z / whole.nearPlane);
        const Exact place = static_cast<Exact>(x) * static_cast<Exact>(whole.nearPlane) / -static_cast<Exact>(z);
        const Exact wanted = pixelOf<Exact>(l, r, place, wholePixels);
        // The part's pixels are `step` whole pixels wide and centred on the pixels that they stand for.
        const Exact first = static_cast<Exact>(axis.origin) + static_cast<Exact>(axis.kernel) + 0.5L -
                            static_cast<Exact>(axis.step) / 2;
        const Exact got = first + pixelOf<Exact>(pl, pr, place, partPixels) * axis.step;
        off.byDoubles = std::max(off.byDoubles, static_cast<double>(std::abs(got - wanted)));
        const Exact drawn =
            first + static_cast<Exact>(pixelByFloats(pl, pr, whole.nearPlane, x, z, partPixels)) * axis.step;
        off.byFloats = std::max(off.byFloats, static_cast<double>(std::abs(drawn - wanted)));
    }
}

Off worst(int width, int height, const std::string& parts) {
    std::mt19937 random(3);
    Off off;
    const Planned all = planned(width, height, ""), divided = planned(width, height, parts);
    for (const Eye eye : {Eye::Left, Eye::Right}) {
        const std::vector<RenderContext> whole = drawn(all, "d", eye), pieces = drawn(divided, "s", eye);
        EXPECT_EQ(whole.size(), 1U);
        EXPECT_FALSE(pieces.empty());
        if (whole.empty()) continue;
        for (const RenderContext& c : pieces) {
            measure(random, whole[0].perspective, c.perspective, true, width, c.viewport.w, c.x, off);
            measure(random, whole[0].perspective, c.perspective, false, height, c.viewport.h, c.y, off);
            EXPECT_EQ(c.perspective.nearPlane, whole[0].perspective.nearPlane); // depths must be bit-identical
            EXPECT_EQ(c.perspective.farPlane, whole[0].perspective.farPlane);
        }
    }
    return off;
}

std::string part(const std::string& what) { return "compound { channel \"s\" " + what + " outputframe { } } "; }

std::string tiles(int columns, int rows) {
    std::string all;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            char text[200];
            std::snprintf(text, sizeof text, "viewport [ %.9f %.9f %.9f %.9f ]", 1. * x / columns, 1. * y / rows,
                          1. / columns, 1. / rows);
            all += part(text);
        }
    return all;
}

// OpenGL rasterises on a grid of at most 1/256 pixel: a part's error must stay below.
void expectExact(int width, int height, const std::string& parts, const std::string& what) {
    const Off off = worst(width, height, parts);
    SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
    numerics::expectWithin("frusta of " + what + ", both eyes, 253x191 to 8191x4099", "64 bits of mantissa",
                           off.byDoubles, 1e-8, "pixels");
    numerics::expectWithin("the same through OpenGL's floats: " + what, "64 bits of mantissa", off.byFloats, 1.0 / 256,
                           "pixels");
}

TEST(Frusta, matchTheCompleteFrustumForTiles) {
    for (const auto& [width, height] :
         {std::pair(253, 191), std::pair(1000, 777), std::pair(1921, 1081), std::pair(8191, 4099)})
        for (const auto& [columns, rows] :
             {std::pair(1, 1), std::pair(2, 1), std::pair(3, 3), std::pair(7, 5), std::pair(16, 1)})
            expectExact(width, height, tiles(columns, rows), "tiles");
}

TEST(Frusta, hitPixelCentresForKernels) {
    for (const auto& [width, height] : {std::pair(253, 191), std::pair(1921, 1081), std::pair(4099, 2047)})
        for (const auto& [w, h] : {std::pair(2, 1), std::pair(3, 1), std::pair(2, 2), std::pair(4, 3), std::pair(8, 8)})
            for (const auto& [x, y] : {std::pair(0, 0), std::pair(w - 1, h - 1), std::pair(w / 2, 0)}) {
                char text[100];
                std::snprintf(text, sizeof text, "pixel [ %d %d %d %d ]", x, y, w, h);
                expectExact(width, height, part(text), "kernels");
            }
}

TEST(Frusta, matchTheCompleteFrustumForTilesOfKernelsOfTiles) {
    expectExact(1921, 1081,
                "compound { viewport [ .1 .3 .5 .7 ] compound { channel \"s\" pixel [ 1 0 3 2 ] viewport [ .3 0 .7 .9 "
                "] outputframe { } } }",
                "mixed");
    expectExact(1921, 1081,
                "compound { pixel [ 2 1 3 2 ] compound { channel \"s\" viewport [ .5 .1 .5 .9 ] outputframe { } } }",
                "mixed");
}

} // namespace
} // namespace mural::compound
