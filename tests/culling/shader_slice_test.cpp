#include "nodes/culling/shader_slice.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "nodes/culling/slice_view.hpp"
#include "tests/culling/random_views.hpp"

namespace mural::culling {
namespace {

// The values of the uniforms of a slice: `of` returns one component.
template <class Of> std::vector<float> uniformsOf(const ShaderSlice& slice, Of&& of) {
    std::vector<float> values;
    for (const SliceSource& source : slice.uniforms) values.push_back(of(source.name, source.component));
    return values;
}

// Number of the input, kMaxInputs: not read.
size_t inputOf(const ShaderSlice& slice, const std::string& name, uint32_t component) {
    const auto found = std::ranges::find(slice.inputs, SliceSource{name, component});
    return static_cast<size_t>(found - slice.inputs.begin());
}

TEST(ShaderSlice, matrixChainsAreLinearWhateverTheirOrder) {
    for (const char* const expression :
         {"projection * modelview * vec4(position, 1.0)", "projection * (modelview * vec4(position, 1.0))",
          "(vec4(position, 1.0) * transposed) * 1.0", "transform(projection, position)"}) {
        const std::string text = std::string("uniform mat4 projection, modelview, transposed;\n"
                                             "attribute vec3 position; attribute vec3 normal; varying vec3 lit;\n"
                                             "vec4 transform(mat4 m, in vec3 p) { vec4 q = modelview * vec4(p, 1.0);"
                                             " return m * q; }\n"
                                             "void main() { lit = normalize(normal) * 0.5; gl_Position = ") +
                                 expression + "; }";
        ShaderSlice slice = sliceOf(text);
        ASSERT_TRUE(slice.isUsable()) << expression << ": " << slice.reason;
        EXPECT_EQ(slice.inputs.size(), 3U) << "the normal decides no position";
        for (unsigned seed = 0; seed < 50; ++seed) {
            RandomView random(seed);
            const LinearView wanted = fixedFunctionView(random.projection, random.modelview, 3);
            const auto view = SliceView(slice).viewFor(uniformsOf(slice, [&](const std::string& name, uint32_t i) {
                if (name == "projection") return random.projection[i];
                if (name == "modelview") return random.modelview[i];
                double sum = 0; // the transposed product: element (row, column) of it is (column, row)
                const uint32_t row = i / 4, column = i % 4;
                for (uint32_t k = 0; k < 4; ++k)
                    sum += double{random.projection[4 * k + row]} * random.modelview[4 * column + k];
                return static_cast<float>(sum);
            }));
            ASSERT_TRUE(view) << expression;
            for (uint32_t i = 0; i < 3; ++i) {
                const size_t at = inputOf(slice, "position", i);
                ASSERT_LT(at, 3U);
                EXPECT_NEAR(view->x.factor[at], wanted.x.factor[i], view->x.error[at] + wanted.x.error[i]);
                EXPECT_NEAR(view->w.factor[at], wanted.w.factor[i], view->w.error[at] + wanted.w.error[i]);
                EXPECT_LT(view->x.error[at], 1e-4 * (1 + std::abs(wanted.x.factor[i])) * 100);
            }
            EXPECT_NEAR(view->y.constant, wanted.y.constant, view->y.constantError + wanted.y.constantError);
        }
    }
}

TEST(ShaderSlice, readsFixedFunctionState) {
    for (const char* const text :
         {"void main() { gl_FrontColor = gl_Color; gl_Position = ftransform(); }",
          "void main() { gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; }",
          "#version 120\nvoid main() { gl_Position = gl_ProjectionMatrix * gl_ModelViewMatrix * gl_Vertex; }"}) {
        const ShaderSlice slice = sliceOf(text);
        ASSERT_TRUE(slice.isUsable()) << text << slice.reason;
        EXPECT_EQ(slice.inputs.size(), 4U);
        for (const SliceSource& uniform : slice.uniforms)
            EXPECT_TRUE(uniform.name == "gl_ProjectionMatrix" || uniform.name == "gl_ModelViewMatrix") << uniform.name;
    }
}

TEST(ShaderSlice, followsConditionsAndLoopsOfKnownEnd) {
    const ShaderSlice slice = sliceOf(R"(#version 330
layout(location = 0) in vec2 place;
uniform struct Part { vec2 offset; float scale[3]; } parts[2];
uniform bool turned;
uniform int lights;
out vec3 light;
void main() {
    vec2 p = place;
    for (int i = 0; i < 2; ++i) p = p * parts[i].scale[1] + parts[i].offset;
    if (turned) p.xy = p.yx;
    light = vec3(0.0);
    for (int i = 0; i < lights; ++i) light += vec3(float(i));
    if (light.x > 0.5) { light.y = 1.0; }
    gl_Position.zw = vec2(0.5, 1.0);
    gl_Position.xy = p;
})");
    ASSERT_TRUE(slice.isUsable()) << slice.reason;
    for (const float turned : {0.0F, 1.0F}) {
        const auto view = SliceView(slice).viewFor(uniformsOf(slice, [&](const std::string& name, uint32_t) {
            return name == "turned" ? turned : name.find("scale") != std::string::npos ? 3.0F : 10.0F;
        }));
        ASSERT_TRUE(view);
        const size_t x = inputOf(slice, "place", 0), y = inputOf(slice, "place", 1);
        EXPECT_EQ(view->x.factor[turned != 0 ? y : x], 9);
        EXPECT_EQ(view->x.factor[turned != 0 ? x : y], 0);
        EXPECT_EQ(view->x.constant, 40);
        EXPECT_EQ(view->w.constant, 1);
    }
}

TEST(ShaderSlice, saysWhyThereIsNone) {
    for (const char* const main : {"gl_Position = texture2DLod(map, position.xy, 0.0);",
                                   "for (int i = 0; i < count; ++i) gl_Position += vec4(position, 1.0);",
                                   "gl_Position = pow(vec4(position, 1.0), vec4(2.0));",
                                   "if (count > 0) return; gl_Position = vec4(position, 1.0);", "position.x;",
                                   "gl_Position = vec4(position, 1.0); switched;"}) {
        const ShaderSlice slice =
            sliceOf(std::string("uniform sampler2D map; uniform int count; attribute vec3 position;\n"
                                "void main() { ") +
                    main + " }");
        EXPECT_FALSE(slice.isUsable()) << main;
    }
    EXPECT_FALSE(sliceOf("#ifdef GL_ARB_gpu_shader5\n#endif\nvoid main() { gl_Position = vec4(1.0); }").isUsable());
    EXPECT_FALSE(sliceOf("#ifdef GL_NV_fragdepth\n#endif\nvoid main() { gl_Position = vec4(1.0); }").isUsable());
    EXPECT_TRUE(
        sliceOf("#version 110\n#extension GL_ARB_gpu_shader5 : disable\nvoid main() { gl_Position = vec4(1.0); }")
            .isUsable());
}

TEST(ShaderSlice, productsOfAttributesAreNotLinear) {
    const ShaderSlice slice = sliceOf("attribute vec4 a; attribute float b; void main() { gl_Position = a * b; }");
    ASSERT_TRUE(slice.isUsable());
    EXPECT_FALSE(SliceView(slice).viewFor({}));
    const ShaderSlice chosen = sliceOf("attribute vec4 a; void main() { gl_Position = a.x > 0.0 ? a : a * 2.0; }");
    ASSERT_TRUE(chosen.isUsable());
    EXPECT_FALSE(SliceView(chosen).viewFor({}));
}

TEST(ShaderSlice, conditionsThatRoundingMayChangeHaveNoView) {
    const ShaderSlice slice = sliceOf("uniform float t; attribute vec4 a;\n"
                                      "void main() { gl_Position = sin(t) < 0.5 ? a : a * 2.0; }");
    ASSERT_TRUE(slice.isUsable());
    const float close[] = {0.5235988F}, far[] = {0.2F};
    EXPECT_FALSE(SliceView(slice).viewFor(close));
    ASSERT_TRUE(SliceView(slice).viewFor(far));
    EXPECT_EQ(SliceView(slice).viewFor(far)->x.factor[inputOf(slice, "a", 0)], 1);
}

TEST(ShaderSlice, parsesTextsOfOpenGLES) {
    const std::string text = "attribute vec4 position;\nuniform mat4 matrix;\n"
                             "#ifdef GL_ES\nvoid main() { gl_Position = matrix * position; }\n"
                             "#else\nvoid main() { gl_Position = matrix[0]; }\n#endif\n";
    const ShaderSlice es = sliceOf(text, true), desktop = sliceOf(text, false);
    ASSERT_TRUE(es.isUsable()) << es.reason;
    ASSERT_TRUE(desktop.isUsable()) << desktop.reason;
    EXPECT_EQ(es.inputs.size(), 4U);
    EXPECT_TRUE(desktop.inputs.empty()) << "the other branch";
    const ShaderSlice es3 = sliceOf("#version 300 es\nprecision mediump float;\nin vec3 position;\n"
                                    "uniform mat4 matrix;\nvoid main() { gl_Position = matrix * vec4(position, 1.0); }",
                                    true);
    ASSERT_TRUE(es3.isUsable()) << es3.reason;
    EXPECT_EQ(es3.inputs.size(), 3U);
}

} // namespace
} // namespace mural::culling
