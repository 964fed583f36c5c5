// New surfaces hold zero, for any contents of the driver's memory.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <malloc.h>
#include <vector>

#include "tests/gl/backend_test.hpp"

namespace mural::test {
namespace {

// Leaves freed heap memory filled with a pattern, in blocks of the sizes that pictures have.
void fillHeapWithPattern(size_t pictureBytes) {
    constexpr int kBlocks = 24;
    std::vector<void*> blocks;
    for (int i = 0; i < kBlocks; i++) {
        const size_t bytes = pictureBytes + static_cast<size_t>(i) * 256;
        void* const block = std::malloc(bytes);
        if (block) std::memset(block, 0xA5, bytes);
        asm volatile("" : : "r"(block) : "memory"); // keeps the pattern, although no code here reads it
        blocks.push_back(block);
    }
    for (void* block : blocks) std::free(block);
}

class NewSurfaces : public BackendTest, public testing::WithParamInterface<std::string> {
protected:
    void SetUp() override {
        mallopt(M_MMAP_THRESHOLD, 1 << 30); // freed blocks stay in the heap…
        mallopt(M_TRIM_THRESHOLD, 1 << 30); // …and are reused
        open(GetParam());
    }
    void TearDown() override {
        if (platform_) {
            EXPECT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
        }
    }

    [[nodiscard]] gl::SurfaceConfig bits(int width, int height) const {
        gl::SurfaceConfig c;
        c.width = width;
        c.height = height;
        return c;
    }

    // Creates a surface, and expects zeros in all its buffers.
    void expectZero(const gl::SurfaceConfig& requested) {
        SCOPED_TRACE(std::to_string(requested.width) + "x" + std::to_string(requested.height) + " alpha " +
                     std::to_string(requested.alpha) + " samples " + std::to_string(requested.samples));
        fillHeapWithPattern(static_cast<size_t>(requested.width) * static_cast<size_t>(requested.height) * 4);
        gl::ContextConfig config;
        config.major = 2;
        config.minor = 1;
        config.surface = requested;
        const Drawable drawable(*platform_, config);
        ASSERT_EQ(drawable.error, "");
        const GlFunctions gl(find());
        const bool two = drawable.surface->colorBuffers() == gl::ColorBuffers::FrontAndBack;
        for (const GLenum buffer : two ? std::vector<GLenum>{GL_BACK, GL_FRONT} : std::vector<GLenum>{0}) {
            if (buffer) gl.readBuffer(buffer);
            expectZeroPixels(gl, drawable.surface->config());
        }
    }

    static void expectZeroPixels(const GlFunctions& gl, const gl::SurfaceConfig& c) {
        const size_t pixels = static_cast<size_t>(c.width) * static_cast<size_t>(c.height);
        std::vector<uint8_t> colours(pixels * 4, 0xEE);
        gl.readPixels(0, 0, c.width, c.height, GL_RGBA, GL_UNSIGNED_BYTE, colours.data());
        size_t lit = 0, otherAlpha = 0;
        for (size_t i = 0; i < colours.size(); i += 4) {
            lit += colours[i] != 0 || colours[i + 1] != 0 || colours[i + 2] != 0;
            otherAlpha += colours[i + 3] != (c.alpha > 0 ? 0 : 255);
        }
        EXPECT_EQ(lit, 0U);
        EXPECT_EQ(otherAlpha, 0U);
        std::vector<float> depths(pixels, 0.5F);
        gl.readPixels(0, 0, c.width, c.height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
        EXPECT_EQ(std::ranges::count_if(depths, [](float d) { return d != 0; }), 0);
        std::vector<uint8_t> stencils(pixels, 0xEE);
        gl.pixelStorei(GL_PACK_ALIGNMENT, 1);
        gl.readPixels(0, 0, c.width, c.height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencils.data());
        EXPECT_EQ(std::ranges::count_if(stencils, [](uint8_t s) { return s != 0; }), 0);
        EXPECT_EQ(gl.getError(), GLenum{GL_NO_ERROR});
    }
};

TEST_P(NewSurfaces, holdZeroInAllBuffers) {
    for (const auto& [width, height] : {std::pair{4, 4}, {61, 47}, {320, 240}, {1000, 20}}) {
        expectZero(bits(width, height));
        gl::SurfaceConfig withAlpha = bits(width, height);
        withAlpha.alpha = 8;
        expectZero(withAlpha);
    }
}

TEST_P(NewSurfaces, holdZeroWithSamples) {
    if (GetParam() == "osmesa") GTEST_SKIP() << "this backend has no surfaces with samples";
    gl::SurfaceConfig c = bits(200, 100);
    c.samples = 4;
    expectZero(c);
}

// The program's context stays current, with its bindings and its drawing.
TEST_P(NewSurfaces, keepTheCurrentContext) {
    gl::ContextConfig config;
    config.surface = bits(16, 16);
    const Drawable drawable(*platform_, config);
    ASSERT_EQ(drawable.error, "");
    const GlFunctions gl(find());
    gl.clearColor(1, 0, 0, 1);
    gl.clear(GL_COLOR_BUFFER_BIT);
    gl.enable(GL_SCISSOR_TEST);
    auto other = platform_->createSurface(bits(40, 30));
    ASSERT_TRUE(other) << other.error().message;
    uint8_t pixel[4] = {};
    gl.readPixels(8, 8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    EXPECT_EQ(pixel[0], 255);
    GLint scissor = 0;
    gl.getIntegerv(GL_SCISSOR_TEST, &scissor);
    EXPECT_EQ(scissor, 1);
    EXPECT_EQ(gl.getError(), GLenum{GL_NO_ERROR});
}

INSTANTIATE_TEST_SUITE_P(All, NewSurfaces, testing::Values("egl", "osmesa", "glx"),
                         [](const auto& parameter) { return parameter.param; });

} // namespace
} // namespace mural::test
