// Difficult walls: the eye 1 cm from them and in their plane, 2^18 pixels, tiles of one pixel, planes 10^10 apart, and
// degenerate walls.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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

using Exact = long double;
using numerics::expectThat;
using numerics::expectWithin;

// 6 m wide, 1 m in front of the eyes
const std::string kWall = "bottom_left [ -3 -1.5 -1 ] bottom_right [ 3 -1.5 -1 ] top_left [ -3 1.5 -1 ]";

std::string configOf(int width, int height, const std::string& wall, const std::string& parts) {
    const std::string window =
        "window { viewport [ 0 0 " + std::to_string(width) + " " + std::to_string(height) + " ] ";
    return "#Equalizer 1.2 ascii\nconfig { appNode { pipe { " + window + "channel { name \"d\" } } " + window +
           "channel { name \"s\" } } } } "
           "observer { eye_base .065 } layout { view { observer 0 mode STEREO } } canvas { layout 0 wall { " +
           wall +
           " } segment { channel \"d\" } } "
           "compound { channel ( ) " +
           parts + " } }";
}

Planned planned(const std::string& text, const Vector3& head, double nearPlane, double farPlane) {
    config::Diagnostics diagnostics("f");
    Planned p{config::resolve(config::parseConfig(text, diagnostics), {}, diagnostics), {}};
    EXPECT_EQ(diagnostics.errors(), 0) << diagnostics.firstError();
    FrameInput input = firstFrame(p.config);
    input.views.assign(p.config.views.size(), ViewState{config::ViewMode::Stereo, 1, {}});
    input.observers.resize(1);
    input.observers[0].head = Matrix4::translation(head);
    input.nearPlane = nearPlane;
    input.farPlane = farPlane;
    p.plan = planFrame(p.config, input);
    return p;
}

std::string tiles(int columns, int rows) {
    std::string all;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            char text[200];
            std::snprintf(text, sizeof text,
                          "compound { channel \"s\" viewport [ %.12f %.12f %.12f %.12f ] outputframe { } } ",
                          1. * x / columns, 1. * y / rows, 1. / columns, 1. / rows);
            all += text;
        }
    return all;
}

// The error of positions in a part, in pixels; positions are spread over the part.
struct Off {
    double byDoubles = 0; // of the frustum itself
    double byFloats = 0;  // with glFrustum's matrix and the viewport transform in floats
    double whole = 0;     // the same for one picture of the whole size
    double edges = 0;     // between a part's edge and its neighbour's
};

// With glFrustum's matrix, w and the viewport transform in floats.
float pixelByFloats(double l, double r, double nearPlane, float x, float z, int pixels) {
    const auto scale = static_cast<float>(2 * nearPlane / (r - l)), shear = static_cast<float>((r + l) / (r - l)),
               half = static_cast<float>(pixels) / 2;
    return (scale * x + shear * z) / -z * half + half;
}

void along(std::mt19937& random, double l, double r, double pl, double pr, double nearPlane, int whole, int part,
           int origin, Off& off) {
    for (int i = 0; i < 20; ++i) {
        // on the near plane
        const Exact place = static_cast<Exact>(pl) + std::uniform_real_distribution<>(0, 1)(random) *
                                                         (static_cast<Exact>(pr) - static_cast<Exact>(pl));
        const Exact wanted = (place - static_cast<Exact>(l)) / (static_cast<Exact>(r) - static_cast<Exact>(l)) * whole;
        const Exact got =
            origin + (place - static_cast<Exact>(pl)) / (static_cast<Exact>(pr) - static_cast<Exact>(pl)) * part;
        off.byDoubles = std::max(off.byDoubles, static_cast<double>(std::abs(got - wanted)));
        const auto z = static_cast<float>(-nearPlane * std::exp(std::uniform_real_distribution<>(0, 9)(random))),
                   x = static_cast<float>(place * -static_cast<Exact>(z) / nearPlane);
        const Exact seen = static_cast<Exact>(x) * static_cast<Exact>(nearPlane) / -static_cast<Exact>(z);
        const Exact exactly = (seen - static_cast<Exact>(l)) / (static_cast<Exact>(r) - static_cast<Exact>(l)) * whole;
        off.byFloats = std::max(
            off.byFloats, static_cast<double>(std::abs(
                              origin + static_cast<Exact>(pixelByFloats(pl, pr, nearPlane, x, z, part)) - exactly)));
        off.whole = std::max(
            off.whole,
            static_cast<double>(std::abs(static_cast<Exact>(pixelByFloats(l, r, nearPlane, x, z, whole)) - exactly)));
    }
    const double pixelSize = (r - l) / whole;
    off.edges = std::max({off.edges, std::abs(pl - (l + pixelSize * origin)) / pixelSize,
                          std::abs(pr - (l + pixelSize * (origin + part))) / pixelSize});
}

Off worst(int width, int height, const std::string& parts, const Vector3& head, double nearPlane, double farPlane,
          size_t wantedParts) {
    std::mt19937 random(9);
    Off off;
    const Planned all = planned(configOf(width, height, kWall, ""), head, nearPlane, farPlane),
                  divided = planned(configOf(width, height, kWall, parts), head, nearPlane, farPlane);
    for (const Eye eye : {Eye::Left, Eye::Right}) {
        const auto whole = drawn(all, "d", eye), pieces = drawn(divided, "s", eye);
        EXPECT_EQ(whole.size(), 1U);
        EXPECT_EQ(pieces.size(), wantedParts);
        if (whole.empty()) continue;
        const Frustum& f = whole[0].perspective;
        for (const double v : {f.left, f.right, f.bottom, f.top}) EXPECT_TRUE(std::isfinite(v));
        for (const RenderContext& c : pieces) {
            along(random, f.left, f.right, c.perspective.left, c.perspective.right, nearPlane, width, c.viewport.w,
                  c.x.origin, off);
            along(random, f.bottom, f.top, c.perspective.bottom, c.perspective.top, nearPlane, height, c.viewport.h,
                  c.y.origin, off);
            EXPECT_EQ(c.perspective.nearPlane, f.nearPlane); // depths must be bit-identical
            EXPECT_EQ(c.perspective.farPlane, f.farPlane);
        }
    }
    return off;
}

constexpr double kGrid = 1.0 / 256; // OpenGL's rasterisation grid

// With floats a part must be below the grid; for a picture too large for floats, at most twice the error of one such
// picture.
void expectNear(const std::string& what, const Off& off) {
    expectWithin(what + ": a part's frustum", "the whole's, 64 bits of mantissa", off.byDoubles, 1e-6, "pixels");
    expectWithin(what + ": edges of neighbours", "the whole's grid", off.edges, 1e-6, "pixels");
    expectWithin(what + ": vertices through OpenGL's floats", "the whole's, 64 bits of mantissa", off.byFloats,
                 std::max(kGrid, 2 * off.whole), "pixels");
}

TEST(Walls, areExactWithTheEyeACentimetreAway) {
    expectNear("eye 1 cm from a wall of 6 m, 7x5 tiles",
               worst(1921, 1081, tiles(7, 5), {0.4, 0.2, -0.99}, 0.001, 1000, 35));
}

// An eye in the plane would see nothing. It is treated as a tenth of a millimetre in front, and all numbers stay
// finite.
TEST(Walls, areFiniteWithTheEyeInTheirPlane) {
    expectNear("eye in the wall's plane, 7x5 tiles", worst(1921, 1081, tiles(7, 5), {0.4, 0.2, -1}, 0.001, 1000, 35));
    const Planned before = planned(configOf(1921, 1081, kWall, ""), {0, 0, -1 + 1e-4}, 0.1, 100),
                  in = planned(configOf(1921, 1081, kWall, ""), {0, 0, -1}, 0.1, 100);
    const double a = drawn(before, "d", Eye::Left)[0].perspective.right,
                 b = drawn(in, "d", Eye::Left)[0].perspective.right;
    expectWithin("eye in the wall's plane: its frustum", "that of an eye 0.1 mm before it",
                 std::abs(a - b) / std::abs(a), 1e-9, "of its width");
}

TEST(Walls, supportTwoToTheEighteenPixels) {
    constexpr int kWide = 1 << 18, kHigh = 3 << 16;
    expectNear("262144 x 196608 pixels, 16x12 tiles", worst(kWide, kHigh, tiles(16, 12), {}, 0.1, 1000, 192));
    expectNear("262144 x 196608 pixels, 7x5 tiles", worst(kWide, kHigh, tiles(7, 5), {}, 0.1, 1000, 35));
}

TEST(Walls, supportTilesOfOnePixel) {
    expectNear("tiles of 1 pixel, 61x37 of them", worst(61, 37, tiles(61, 37), {}, 0.1, 1000, 61 * 37));
}

TEST(Walls, supportPlanesTenToTheTenApart) {
    expectNear("near plane 10^-4, far plane 10^6, 7x5 tiles", worst(1921, 1081, tiles(7, 5), {}, 1e-4, 1e6, 35));
}

// A degenerate wall is rejected with one line: position and remedy.
TEST(Walls, areRejectedWhenDegenerate) {
    const struct {
        const char *what, *wall;
    } kNone[] = {
        {"a wall without width", "bottom_left [ 0 0 -1 ] bottom_right [ 0 0 -1 ] top_left [ 0 1 -1 ]"},
        {"a wall without height", "bottom_left [ 0 0 -1 ] bottom_right [ 1 0 -1 ] top_left [ 0 0 -1 ]"},
        {"a wall whose corners are on one line", "bottom_left [ 0 0 -1 ] bottom_right [ 1 0 -1 ] top_left [ 2 0 -1 ]"},
        {"a wall whose corner is askew", "bottom_left [ 0 0 -1 ] bottom_right [ 1 0 -1 ] top_left [ .5 1 -1 ]"},
        {"a wall beyond what floats hold", "bottom_left [ 0 0 -1 ] bottom_right [ 1e39 0 -1 ] top_left [ 0 1e39 -1 ]"},
    };
    for (const auto& none : kNone) {
        config::Diagnostics diagnostics("wall.eqc");
        (void)config::resolve(config::parseConfig(configOf(100, 100, none.wall, ""), diagnostics), {}, diagnostics);
        const std::string error = diagnostics.errors() > 0 ? diagnostics.firstError() : "";
        expectThat(none.what, "what a wall is",
                   !error.empty() && error.find('\n') == std::string::npos && error.find("wall.eqc:") == 0,
                   error.empty() ? "taken" : "refused: " + error);
    }
    for (const char* projection :
         {"origin [ 0 0 0 ] distance 0 fov [ 60 40 ]", "origin [ 0 0 0 ] distance 3 fov [ 180 40 ]",
          "origin [ 0 0 0 ] distance 3 fov [ 60 0 ]"}) {
        std::string text = configOf(100, 100, kWall, "");
        const size_t at = text.find("wall {"), end = text.find('}', at);
        text.replace(at, end + 1 - at, std::string("projection { ") + projection + " }");
        config::Diagnostics diagnostics("wall.eqc");
        (void)config::resolve(config::parseConfig(text, diagnostics), {}, diagnostics);
        expectThat(std::string("projection { ") + projection + " }", "what a projection is", diagnostics.errors() > 0,
                   diagnostics.errors() > 0 ? "refused: " + diagnostics.firstError() : "taken");
    }
}

} // namespace
} // namespace mural::compound
