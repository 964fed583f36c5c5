#include "nodes/culling/draw_cut.hpp"

#include <algorithm>
#include <cmath>

#include <GL/gl.h>
#include <gtest/gtest.h>

#include "tests/culling/random_views.hpp"

namespace mural::culling {
namespace {

constexpr ClipWindow kSquare{0, 0, 1000, 1000};

// A row of triangles over the whole width, from left to right: x from -1 to 1.
std::vector<float> rowOfTriangles(size_t triangles) {
    std::vector<float> values;
    for (size_t i = 0; i < triangles; ++i)
        for (int corner = 0; corner < 3; ++corner) {
            values.push_back(2 * static_cast<float>(i) / static_cast<float>(triangles) - 1);
            values.push_back(corner == 1 ? 0.5F : 0);
            values.push_back(0);
        }
    return values;
}

struct CutOf {
    Cut cut;
    std::vector<VertexRange> ranges;
};

CutOf cutRow(const PixelViewport& area, uint32_t mode, bool canCut = true) {
    const float one[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const std::vector<float> values = rowOfTriangles(10'000);
    const AttributeArray array{std::as_bytes(std::span(values)), 12, GL_FLOAT, 3, false};
    const uint64_t count = values.size() / 3;
    const auto boxes = makeBoxes({&array, 1}, {.count = count}, formOf(mode));
    CutOf result;
    result.cut = cutDraw(*boxes, TilePlanes(fixedFunctionView(one, one, 3), kSquare, area, 2), count, formOf(mode),
                         canCut, result.ranges);
    return result;
}

TEST(DrawCut, keepsTheClustersOfTheArea) {
    const CutOf middle = cutRow({450, 0, 100, 1000}, GL_TRIANGLES);
    ASSERT_EQ(middle.cut, Cut::Ranges);
    ASSERT_EQ(middle.ranges.size(), 1U);
    EXPECT_LE(middle.ranges[0].first, 4480U * 3);
    EXPECT_GE(middle.ranges[0].first + middle.ranges[0].count, 5520U * 3);
    EXPECT_LE(middle.ranges[0].count, 1300U * 3);
    EXPECT_EQ(middle.ranges[0].first % 3, 0U);
}

TEST(DrawCut, drawsWholeOrNothingWhereCutsAreNotAllowed) {
    EXPECT_EQ(cutRow({450, 0, 100, 1000}, GL_TRIANGLES, false).cut, Cut::Whole);
    EXPECT_EQ(cutRow({450, 0, 100, 1000}, GL_QUADS).cut, Cut::Whole);
    EXPECT_EQ(cutRow({450, 0, 100, 100}, GL_TRIANGLES, false).cut, Cut::Nothing);
    EXPECT_EQ(cutRow({450, 0, 100, 100}, GL_QUADS).cut, Cut::Nothing);
    EXPECT_EQ(cutRow({0, 0, 1000, 1000}, GL_TRIANGLES).cut, Cut::Whole);
}

TEST(DrawCut, stripsBeginAtEvenVerticesAndOverlap) {
    const CutOf strip = cutRow({450, 0, 100, 1000}, GL_TRIANGLE_STRIP);
    ASSERT_EQ(strip.cut, Cut::Ranges);
    for (const VertexRange& range : strip.ranges) {
        EXPECT_EQ(range.first % 2, 0U);
        EXPECT_EQ(range.count % 64, 2U);
    }
}

// Every triangle with a corner in the area is kept.
TEST(DrawCut, neverLosesAVisibleTriangle) {
    int cuts = 0, nothing = 0;
    for (unsigned seed = 0; seed < 300; ++seed) {
        RandomView view(seed);
        std::vector<float> values;
        for (int i = 0; i < 700; ++i) {
            const float centre[3] = {std::sin(0.01F * static_cast<float>(i)) * 10, 0.02F * static_cast<float>(i) - 7,
                                     std::cos(0.01F * static_cast<float>(i)) * 10};
            for (int corner = 0; corner < 3; ++corner)
                for (const float c : centre) values.push_back(c + view.between(-0.2F, 0.2F));
        }
        const AttributeArray array{std::as_bytes(std::span(values)), 12, GL_FLOAT, 3, false};
        const auto boxes = makeBoxes({&array, 1}, {.count = values.size() / 3}, formOf(GL_TRIANGLES));
        const PixelViewport area{static_cast<int32_t>(view.between(0, 800)), 300, 200, 300};
        const TilePlanes planes(fixedFunctionView(view.projection, view.modelview, 3), kSquare, area, 1);
        std::vector<VertexRange> ranges;
        const Cut cut = cutDraw(*boxes, planes, values.size() / 3, formOf(GL_TRIANGLES), true, ranges);
        cuts += cut == Cut::Ranges;
        nothing += cut == Cut::Nothing;
        for (size_t vertex = 0; vertex < values.size() / 3; ++vertex) {
            const auto [x, y, w] = view.clip({values[3 * vertex], values[3 * vertex + 1], values[3 * vertex + 2]});
            const double px = (double{x} / w + 1) * 500, py = (double{y} / w + 1) * 500;
            if (w <= 0 || px < area.x || px > area.right() || py < area.y || py > area.top()) continue;
            const bool kept =
                cut == Cut::Whole || (cut == Cut::Ranges && std::ranges::any_of(ranges, [&](const VertexRange& r) {
                                          return vertex >= r.first && vertex < r.first + r.count;
                                      }));
            ASSERT_TRUE(kept) << "seed " << seed << ", vertex " << vertex;
        }
    }
    EXPECT_GT(cuts, 30);
    EXPECT_GT(nothing, 30);
}

} // namespace
} // namespace mural::culling
