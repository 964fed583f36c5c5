// Numbers of values at pointer parameters.
#include <gtest/gtest.h>

#include "streamcodec/sizes/gl_enums.hpp"
#include "streamcodec/sizes/parameter_counts.hpp"

namespace mural::sizes {
namespace {

TEST(SizesParameterCounts, countTextureParameters) {
    EXPECT_EQ(texParameterCount(GL_TEXTURE_MIN_FILTER), 1u);
    EXPECT_EQ(texParameterCount(GL_TEXTURE_BORDER_COLOR), 4u);
    EXPECT_EQ(texParameterCount(GL_TEXTURE_SWIZZLE_RGBA), 4u);
    EXPECT_EQ(texParameterCount(GL_TEXTURE_CROP_RECT_OES), 4u);
    EXPECT_EQ(texParameterCount(GL_TEXTURE_CLIPMAP_VIRTUAL_DEPTH_SGIX), 3u);
    EXPECT_EQ(samplerParameterCount(GL_TEXTURE_BORDER_COLOR), 4u);
    EXPECT_EQ(samplerParameterCount(GL_TEXTURE_WRAP_S), 1u);
    EXPECT_EQ(texEnvCount(GL_TEXTURE_ENV_COLOR), 4u);
    EXPECT_EQ(texEnvCount(GL_TEXTURE_ENV_MODE), 1u);
    EXPECT_EQ(texGenCount(GL_EYE_PLANE), 4u);
    EXPECT_EQ(texGenCount(GL_TEXTURE_GEN_MODE), 1u);
    EXPECT_EQ(texGenCount(GL_EYE_LINE_SGIS), 7u);
    EXPECT_EQ(texBumpParameterCount(GL_BUMP_ROT_MATRIX_ATI), 4u);
}

TEST(SizesParameterCounts, countFixedFunctionParameters) {
    EXPECT_EQ(lightCount(GL_POSITION), 4u);
    EXPECT_EQ(lightCount(GL_SPOT_DIRECTION), 3u);
    EXPECT_EQ(lightCount(GL_SPOT_CUTOFF), 1u);
    EXPECT_EQ(lightModelCount(GL_LIGHT_MODEL_AMBIENT), 4u);
    EXPECT_EQ(lightModelCount(GL_LIGHT_MODEL_TWO_SIDE), 1u);
    EXPECT_EQ(materialCount(GL_AMBIENT_AND_DIFFUSE), 4u);
    EXPECT_EQ(materialCount(GL_COLOR_INDEXES), 3u);
    EXPECT_EQ(materialCount(GL_SHININESS), 1u);
    EXPECT_EQ(fogCount(GL_FOG_COLOR), 4u);
    EXPECT_EQ(fogCount(GL_FOG_DENSITY), 1u);
    EXPECT_EQ(pointParameterCount(GL_POINT_DISTANCE_ATTENUATION), 3u);
    EXPECT_EQ(pointParameterCount(GL_POINT_SIZE_MIN), 1u);
    EXPECT_EQ(patchParameterCount(GL_PATCH_DEFAULT_INNER_LEVEL), 2u);
    EXPECT_EQ(patchParameterCount(GL_PATCH_DEFAULT_OUTER_LEVEL), 4u);
    EXPECT_EQ(convolutionParameterCount(GL_CONVOLUTION_FILTER_BIAS), 4u);
    EXPECT_EQ(convolutionParameterCount(GL_CONVOLUTION_BORDER_MODE), 1u);
    EXPECT_EQ(colorTableParameterCount(GL_COLOR_TABLE_SCALE), 4u);
    EXPECT_EQ(combinerParameterCount(GL_CONSTANT_COLOR1_NV), 4u);
    EXPECT_EQ(combinerParameterCount(GL_NUM_GENERAL_COMBINERS_NV), 1u);
    EXPECT_EQ(spriteParameterCount(GL_SPRITE_AXIS_SGIX), 3u);
}

TEST(SizesParameterCounts, countBuffersAndSymbols) {
    EXPECT_EQ(clearBufferCount(GL_COLOR), 4u);
    EXPECT_EQ(clearBufferCount(GL_DEPTH), 1u);
    EXPECT_EQ(clearBufferCount(GL_DEPTH_STENCIL), 0u);
    EXPECT_EQ(variantCount(GL_MATRIX_EXT), 16u);
    EXPECT_EQ(variantCount(GL_FLOAT), 0u);
}

TEST(SizesParameterCounts, countTextsAndLists) {
    EXPECT_EQ(stringBytes("tile", -1), 5u);
    EXPECT_EQ(stringBytes("tile", 2), 2u);
    EXPECT_EQ(stringBytes("tile", 0), 0u);
    EXPECT_EQ(stringBytes(nullptr, 7), 0u);
    const GLint list[] = {GL_SURFACE_COMPRESSION_EXT, 1, GL_NONE, 9};
    EXPECT_EQ(attribListCount(list), 3u);
    EXPECT_EQ(attribListCount(nullptr), 0u);
}

} // namespace
} // namespace mural::sizes
