// OSMesa keeps buffers in contexts; ours behave as surfaces: their contents move between contexts, and a context finds
// each surface unchanged.
#include <algorithm>

#include "tests/gl/backend_test.hpp"
#include "tests/gl/scene.hpp"

namespace mural::test {
namespace {

class OsmesaSurfaces : public BackendTest {
protected:
    void SetUp() override {
        open("osmesa");
        config_.surface.width = 67;
        config_.surface.height = 45;
        config_.surface.alpha = 8;
    }
    void TearDown() override {
        if (!platform_) return;
        EXPECT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
    }

    // Each copy may change a 24-bit depth by one unit: see osmesa_pixels.hpp.
    static void expectCopied(Picture expected, Picture actual, int copies, int depthBits = 24) {
        ASSERT_EQ(expected.depth.size(), actual.depth.size());
        uint32_t largest = 0;
        for (size_t i = 0; i < expected.depth.size(); i++)
            largest = std::max(largest, std::max(expected.depth[i], actual.depth[i]) -
                                            std::min(expected.depth[i], actual.depth[i]));
        EXPECT_LE(largest, depthBits == 24 ? 256u * static_cast<unsigned>(copies) : 0u);
        expected.depth = actual.depth;
        EXPECT_EQ(difference(expected, actual), "");
    }

    Picture draw() { return drawScene(find(), config_, config_.surface); }
    Picture read() { return readPicture(GlFunctions(find()), config_, config_.surface); }
    void use(const std::unique_ptr<gl::Context>& context, gl::Surface& surface) {
        auto current = platform_->makeCurrent(context.get(), &surface, &surface);
        ASSERT_TRUE(current) << current.error().message;
    }

    gl::ContextConfig config_;
};

TEST_F(OsmesaSurfaces, areSeparateInOneContext) {
    Drawable first(*platform_, config_);
    ASSERT_EQ(first.error, "");
    const Picture drawn = draw();
    auto other = platform_->createSurface(config_.surface);
    ASSERT_TRUE(other);
    use(first.context, **other);
    const GlFunctions gl(find());
    gl.disable(GL_BLEND);
    gl.clearColor(1, 0, 1, 1);
    gl.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    const Picture pink = read();
    EXPECT_NE(difference(drawn, pink), "");
    use(first.context, *first.surface);
    expectCopied(drawn, read(), 1);
    use(first.context, **other);
    expectCopied(pink, read(), 1);
}

TEST_F(OsmesaSurfaces, keepContentsBetweenContexts) {
    for (const int depth : {16, 24}) {
        config_.surface.depth = depth;
        config_.surface.stencil = depth == 24 ? 8 : 0;
        Drawable first(*platform_, config_);
        ASSERT_EQ(first.error, "");
        const Picture drawn = draw();
        gl::ContextConfig core = config_;
        core.core = true;
        core.major = core.minor = 3;
        auto second = platform_->createContext(core, nullptr);
        ASSERT_TRUE(second);
        use(second.value(), *first.surface);
        expectCopied(drawn, read(), 1, depth);
        first.context.reset(); // the surface outlives the context that drew it
        expectCopied(drawn, read(), 1, depth);
        second.value().reset();
        auto third = platform_->createContext(config_, nullptr);
        use(third.value(), *first.surface);
        expectCopied(drawn, read(), 2, depth);
        ASSERT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
    }
}

TEST_F(OsmesaSurfaces, keepRgb565) {
    config_.surface.red = config_.surface.blue = 5;
    config_.surface.green = 6;
    config_.surface.alpha = 0;
    Drawable first(*platform_, config_);
    ASSERT_EQ(first.error, "");
    const Picture drawn = draw();
    auto second = platform_->createContext(config_, nullptr);
    ASSERT_TRUE(second);
    use(second.value(), *first.surface);
    expectCopied(drawn, read(), 1);
    ASSERT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
}

// The copies must not change the pixel transfer state.
TEST_F(OsmesaSurfaces, preserveGlState) {
    Drawable first(*platform_, config_);
    ASSERT_EQ(first.error, "");
    const Picture drawn = draw();
    auto other = platform_->createSurface(config_.surface);
    ASSERT_TRUE(other);
    const GlFunctions gl(find());
    gl.pixelStorei(GL_UNPACK_ALIGNMENT, 8);
    gl.pixelStorei(GL_PACK_SKIP_ROWS, 3);
    gl.pixelTransferf(GL_RED_SCALE, 0.5f);
    gl.pixelTransferf(GL_DEPTH_BIAS, 0.25f);
    gl.enable(GL_SCISSOR_TEST);
    gl.scissor(1, 2, 3, 4);
    gl.drawBuffer(GL_NONE);
    GLuint texture = 0;
    gl.genTextures(1, &texture);
    gl.bindTexture(GL_TEXTURE_2D, texture);
    use(first.context, **other);
    use(first.context, *first.surface);
    auto integer = [&](GLenum name) {
        GLint value = -1;
        gl.getIntegerv(name, &value);
        return value;
    };
    EXPECT_EQ(integer(GL_UNPACK_ALIGNMENT), 8);
    EXPECT_EQ(integer(GL_PACK_SKIP_ROWS), 3);
    EXPECT_EQ(integer(GL_DRAW_BUFFER), GL_NONE);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), static_cast<GLint>(texture));
    EXPECT_EQ(integer(GL_DRAW_FRAMEBUFFER_BINDING), 0);
    EXPECT_TRUE(gl.isEnabled(GL_SCISSOR_TEST));
    float scale = 0;
    gl.getFloatv(GL_RED_SCALE, &scale);
    EXPECT_EQ(scale, 0.5f);
    EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_NO_ERROR));
    gl.pixelStorei(GL_PACK_SKIP_ROWS, 0);
    gl.pixelTransferf(GL_RED_SCALE, 1);
    gl.pixelTransferf(GL_DEPTH_BIAS, 0);
    expectCopied(drawn, read(), 1);
}

// Mesa 22.3.6 keeps the orientation of a framebuffer object across a clear; the copies use one.
TEST_F(OsmesaSurfaces, doNotFlipTheFirstSceneAfterACopy) {
    Drawable first(*platform_, config_);
    ASSERT_EQ(first.error, "");
    const Picture once = draw();
    auto other = platform_->createSurface(config_.surface);
    ASSERT_TRUE(other);
    const GlFunctions gl(find());
    use(first.context, **other);
    gl.disable(GL_BLEND); // as in a new context
    gl.disable(GL_TEXTURE_2D);
    gl.lineWidth(1);
    use(first.context, *first.surface); // restored by a copy
    EXPECT_EQ(difference(once, draw()), "");
}

TEST_F(OsmesaSurfaces, startWithOpaqueHiddenAlpha) {
    config_.surface.alpha = 0;
    Drawable drawable(*platform_, config_);
    ASSERT_EQ(drawable.error, "");
    ASSERT_TRUE(drawable.surface->hiddenAlpha());
    const GlFunctions gl(find());
    uint8_t pixel[4] = {9, 9, 9, 9};
    gl.readPixels(20, 20, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    EXPECT_EQ(pixel[0], 0);
    EXPECT_EQ(pixel[3], 255);
    GLfloat clear[4] = {};
    gl.getFloatv(GL_COLOR_CLEAR_VALUE, clear);
    EXPECT_EQ(clear[3], 0.0f);
}

TEST_F(OsmesaSurfaces, mayBeDestroyedBeforeTheirContext) {
    Drawable drawable(*platform_, config_);
    ASSERT_EQ(drawable.error, "");
    draw();
    drawable.surface.reset();
    const GlFunctions gl(find());
    gl.finish(); // writes to the memory that was bound
    auto next = platform_->createSurface(config_.surface);
    ASSERT_TRUE(next);
    use(drawable.context, **next);
    draw();
    gl.finish();
    EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_NO_ERROR));
    next.value().reset();
}

// A 24-bit display has no 16-bit windows, so the backends are compared with each other.
TEST_F(OsmesaSurfaces, matchEglInRgb565) {
    config_.surface.red = config_.surface.blue = 5;
    config_.surface.green = 6;
    config_.surface.alpha = 0;
    Picture pictures[2];
    for (int i = 0; i < 2; i++) {
        if (i == 1) open("egl");
        ASSERT_NE(platform_, nullptr);
        Drawable drawable(*platform_, config_);
        ASSERT_EQ(drawable.error, "");
        pictures[i] = draw();
        ASSERT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
    }
    EXPECT_EQ(difference(pictures[0], pictures[1]), "");
}

} // namespace
} // namespace mural::test
