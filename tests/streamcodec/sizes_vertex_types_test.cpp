// Vertex types, indirect commands, display list names and evaluator maps.
#include <gtest/gtest.h>

#include "streamcodec/sizes/evaluator_maps.hpp"
#include "streamcodec/sizes/gl_enums.hpp"
#include "streamcodec/sizes/parameter_counts.hpp"

namespace mural::sizes {
namespace {

TEST(SizesVertexTypes, computeAttributes) {
    EXPECT_EQ(attributeBytes(3, GL_FLOAT), 12u);
    EXPECT_EQ(attributeBytes(4, GL_DOUBLE), 32u);
    EXPECT_EQ(attributeBytes(2, GL_HALF_FLOAT), 4u);
    EXPECT_EQ(attributeBytes(3, GL_FIXED), 12u);
    EXPECT_EQ(attributeBytes(GL_BGRA, GL_UNSIGNED_BYTE), 4u);
    EXPECT_EQ(attributeBytes(GL_BGRA, GL_INT_2_10_10_10_REV), 4u);
    EXPECT_EQ(attributeBytes(4, GL_UNSIGNED_INT_2_10_10_10_REV), 4u);
    EXPECT_EQ(attributeBytes(3, GL_UNSIGNED_INT_10F_11F_11F_REV), 4u);
    EXPECT_EQ(attributeBytes(1, GL_UNSIGNED_INT64_ARB), 8u);
    EXPECT_EQ(attributeBytes(5, GL_FLOAT), 0u);
    EXPECT_EQ(attributeBytes(0, GL_FLOAT), 0u);
    EXPECT_EQ(attributeBytes(3, GL_RGBA), 0u);
}

TEST(SizesVertexTypes, computeIndirectCommands) {
    EXPECT_EQ(indirectBytes(false, 1, 0), 16u);
    EXPECT_EQ(indirectBytes(true, 3, 0), 60u);
    EXPECT_EQ(indirectBytes(true, 3, 32), 84u); // nothing after the last command
    EXPECT_EQ(indirectBytes(true, 0, 0), 0u);
    EXPECT_EQ(indirectBytes(true, -1, 0), 0u);
}

TEST(SizesVertexTypes, computeCallLists) {
    EXPECT_EQ(callListsBytes(5, GL_UNSIGNED_BYTE), 5u);
    EXPECT_EQ(callListsBytes(5, GL_2_BYTES), 10u);
    EXPECT_EQ(callListsBytes(5, GL_3_BYTES), 15u);
    EXPECT_EQ(callListsBytes(5, GL_FLOAT), 20u);
    EXPECT_EQ(callListsBytes(5, GL_DOUBLE), 0u);
    EXPECT_EQ(callListsBytes(-5, GL_INT), 0u);
}

TEST(SizesEvaluatorMaps, countValues) {
    EXPECT_EQ(map1Values(GL_MAP1_VERTEX_3, 3, 4), 12u);
    EXPECT_EQ(map1Values(GL_MAP1_VERTEX_3, 7, 4), 24u);
    EXPECT_EQ(map1Values(GL_MAP1_VERTEX_3, 2, 4), 0u);
    EXPECT_EQ(map1Values(GL_MAP1_VERTEX_3, 3, 0), 0u);
    EXPECT_EQ(map1Values(GL_LINES, 3, 4), 0u);
    EXPECT_EQ(map2Values(GL_MAP2_COLOR_4, 20, 3, 4, 5), 60u);
    EXPECT_EQ(map2Values(GL_MAP2_COLOR_4, 4, 5, 22, 3), 64u); // u within v
    EXPECT_EQ(map2Values(GL_MAP2_COLOR_4, 3, 3, 4, 5), 0u);
    EXPECT_EQ(map2Values(GL_MAP2_COLOR_4, 20, 3, 4, -5), 0u);
}

TEST(SizesEvaluatorMaps, copyWithoutGaps) {
    const float curve[] = {1, 2, 0, 3, 4, 0, 5, 6};
    float tight[6] = {};
    EXPECT_EQ(packMap1(tight, curve, GL_MAP1_TEXTURE_COORD_2, 3, 3), 6u);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(tight[i], static_cast<float>(i + 1));

    // 2 rows (u) of 3 points (v), stored with u within v
    const double surface[] = {1, 4, -1, 2, 5, -1, 3, 6};
    double flat[6] = {};
    EXPECT_EQ(packMap2(flat, surface, GL_MAP2_INDEX, 1, 2, 3, 3), 6u);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(flat[i], i + 1.0);
    EXPECT_EQ(packMap2(flat, surface, GL_MAP2_INDEX, 1, 0, 3, 3), 0u);
}

} // namespace
} // namespace mural::sizes
