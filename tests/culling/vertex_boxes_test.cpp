#include "nodes/culling/vertex_boxes.hpp"

#include <cmath>
#include <random>

#include <GL/gl.h>
#include <GL/glext.h>
#include <gtest/gtest.h>

namespace mural::culling {
namespace {

template <class T> std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

AttributeArray floats(const std::vector<float>& values, uint32_t components) {
    return {bytesOf(values), components * sizeof(float), GL_FLOAT, components, false};
}

TEST(VertexBoxes, boundTheVerticesOfADraw) {
    const std::vector<float> values{9, 9, 1, 5, -2, 6, 3, 4, 9, 9};
    const AttributeArray array = floats(values, 2);
    const auto boxes = makeBoxes({&array, 1}, {.count = 3, .first = 1}, {});
    ASSERT_TRUE(boxes);
    EXPECT_EQ(boxes->lowest()[0], -2);
    EXPECT_EQ(boxes->lowest()[1], 4);
    EXPECT_EQ(boxes->highest()[0], 3);
    EXPECT_EQ(boxes->highest()[1], 6);
    EXPECT_TRUE(boxes->levels().empty());
}

TEST(VertexBoxes, followIndicesAndSkipTheRestartIndex) {
    const std::vector<float> values{0, 10, 20, 30};
    const std::vector<uint16_t> indices{1, 0xffff, 2};
    const AttributeArray array = floats(values, 1);
    VertexSequence vertices{.count = 3, .indices = bytesOf(indices), .indexBytes = 2, .restart = 0xffff};
    const auto boxes = makeBoxes({&array, 1}, vertices, {});
    ASSERT_TRUE(boxes);
    EXPECT_EQ(boxes->lowest()[0], 10);
    EXPECT_EQ(boxes->highest()[0], 20);
    EXPECT_EQ(indexBounds(vertices)->highest, 2U);
    vertices.restart.reset();
    EXPECT_FALSE(makeBoxes({&array, 1}, vertices, {})) << "an index outside of the array";
    vertices.restart = 0xffff;
    vertices.first = 1;
    EXPECT_EQ(makeBoxes({&array, 1}, vertices, {})->highest()[0], 30);
    vertices.first = 2;
    EXPECT_FALSE(makeBoxes({&array, 1}, vertices, {}));
    vertices.first = -2;
    EXPECT_FALSE(makeBoxes({&array, 1}, vertices, {}));
}

TEST(VertexBoxes, refuseNumbersThatAreNotFinite) {
    for (const float bad : {NAN, INFINITY, -INFINITY}) {
        const std::vector<float> values{0, 1, bad, 3};
        const AttributeArray array = floats(values, 1);
        EXPECT_FALSE(makeBoxes({&array, 1}, {.count = 4}, {}));
        EXPECT_TRUE(makeBoxes({&array, 1}, {.count = 2}, {}));
    }
    const std::vector<uint16_t> halves{0x3c00, 0x7c00};
    const AttributeArray half{bytesOf(halves), 2, GL_HALF_FLOAT, 1, false};
    EXPECT_FALSE(makeBoxes({&half, 1}, {.count = 2}, {}));
    EXPECT_EQ(makeBoxes({&half, 1}, {.count = 1}, {})->highest()[0], 1);
}

TEST(VertexBoxes, contentsOfOtherTypes) {
    const std::vector<int16_t> shorts{-3, 7};
    AttributeArray array{bytesOf(shorts), 2, GL_SHORT, 1, false};
    EXPECT_EQ(makeBoxes({&array, 1}, {.count = 2}, {})->lowest()[0], -3);
    array.isNormalized = true;
    EXPECT_LE(makeBoxes({&array, 1}, {.count = 2}, {})->lowest()[0], -3 / 32767.0);
    const std::vector<double> doubles{0.1, 0.2};
    const AttributeArray wide{bytesOf(doubles), 8, GL_DOUBLE, 1, false};
    const auto boxes = makeBoxes({&wide, 1}, {.count = 2}, {});
    EXPECT_LE(double{boxes->lowest()[0]}, 0.1);
    EXPECT_GE(double{boxes->highest()[0]}, 0.2);
    const AttributeArray packed{bytesOf(shorts), 4, GL_INT_2_10_10_10_REV, 4, true};
    EXPECT_FALSE(makeBoxes({&packed, 1}, {.count = 1}, {}));
}

// The box of each cluster contains every vertex of its primitives, and each level contains the lower one.
TEST(VertexBoxes, clustersContainTheirVertices) {
    std::mt19937 numbers(3);
    for (const uint32_t mode : {GL_POINTS, GL_LINES, GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_LINE_STRIP}) {
        std::vector<float> values;
        std::vector<uint32_t> indices;
        for (int i = 0; i < 3000; ++i) values.push_back(static_cast<float>(numbers() % 10000));
        for (int i = 0; i < 20000; ++i) indices.push_back(numbers() % 1000);
        const AttributeArray array = floats(values, 3);
        const PrimitiveForm form = formOf(mode);
        const VertexSequence vertices{.count = indices.size(), .indices = bytesOf(indices), .indexBytes = 4};
        const auto boxes = makeBoxes({&array, 1}, vertices, form);
        ASSERT_TRUE(boxes && boxes->levels().size() == kClusterLevels);
        for (size_t level = 0; level < kClusterLevels; ++level) {
            const uint64_t step = boxes->levels()[level].vertices;
            EXPECT_EQ(step, uint64_t{form.step} * kClusterPrimitives[level]);
            ASSERT_EQ(boxes->clusters(level), (indices.size() + step - 1) / step);
            for (size_t i = 0; i < indices.size(); ++i)
                for (size_t cluster = i / step; cluster + 1 > 0 && cluster * step + step + form.overlap > i; --cluster)
                    for (size_t c = 0; c < 3; ++c) {
                        ASSERT_LE(boxes->lowest(level, cluster)[c], values[3 * indices[i] + c]);
                        ASSERT_GE(boxes->highest(level, cluster)[c], values[3 * indices[i] + c]);
                    }
        }
    }
}

TEST(VertexBoxes, fansAndQuadsHaveNoClusters) {
    for (const uint32_t mode : {GL_QUADS, GL_QUAD_STRIP, GL_POLYGON, GL_TRIANGLE_FAN, GL_LINE_LOOP, GL_PATCHES})
        EXPECT_EQ(formOf(mode).step, 0U);
}

} // namespace
} // namespace mural::culling
