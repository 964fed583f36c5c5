// The contract of every backend: versions, buffers, errors that name the requested feature, probing.
#include <algorithm>
#include <thread>

#include "nodes/gl/config_match.hpp"
#include "nodes/gl/egl_devices.hpp"
#include "nodes/gl/gl_probe.hpp"
#include "tests/gl/backend_test.hpp"
#include "tests/gl/scene.hpp"

namespace mural::test {
namespace {

gl::ContextConfig version(int major, int minor, bool core = false, gl::Api api = gl::Api::Desktop) {
    gl::ContextConfig config;
    config.api = api;
    config.major = major;
    config.minor = minor;
    config.core = core;
    config.surface.width = config.surface.height = 16;
    return config;
}

class Backends : public BackendTest, public testing::WithParamInterface<std::string> {
protected:
    void SetUp() override { open(GetParam()); }
    void TearDown() override {
        if (!platform_) return;
        EXPECT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
    }

    [[nodiscard]] bool isOsmesa() const { return GetParam() == "osmesa"; }
    [[nodiscard]] bool isMesas() const { return platform_->describe().find("Mesa") != std::string::npos; }

    std::string errorOf(const gl::ContextConfig& config) {
        auto context = platform_->createContext(config, nullptr);
        return context ? "" : context.error().message;
    }
    std::string errorOf(const gl::SurfaceConfig& config) {
        auto surface = platform_->createSurface(config);
        return surface ? "" : surface.error().message;
    }

    // The red component that both names of a buffer show after one of them was cleared.
    static int redOf(const GlFunctions& gl) {
        uint8_t pixel[4] = {1, 2, 3, 4};
        gl.readPixels(3, 3, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
        return pixel[0];
    }
    static void clearRed(const GlFunctions& gl, int red) {
        gl.clearColor(static_cast<float>(red) / 255.0f, 0, 0, 1);
        gl.clear(GL_COLOR_BUFFER_BIT);
    }

    // NVIDIA's pbuffers.
    static void oneBufferNamedBack(const GlFunctions& gl) {
        GLint first = 0;
        gl.getIntegerv(GL_DRAW_BUFFER, &first);
        EXPECT_EQ(first, GL_BACK);
        const auto backRead = [&] { return gl.readBuffer(GL_BACK), redOf(gl); };
        const GLenum back = GL_BACK;
        clearRed(gl, 10);
        gl.drawBuffer(GL_NONE);
        clearRed(gl, 20);
        EXPECT_EQ(backRead(), 10);
        int red = 50;
        for (const GLenum name : {GL_BACK, GL_BACK_LEFT}) {
            gl.drawBuffer(GL_NONE);
            gl.drawBuffer(name);
            clearRed(gl, ++red);
            EXPECT_EQ(backRead(), red) << name;
        }
        gl.drawBuffer(GL_NONE);
        gl.drawBuffers(1, &back);
        clearRed(gl, 30);
        EXPECT_EQ(backRead(), 30);
        EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_NO_ERROR));
        for (const GLenum name : {GL_FRONT, GL_FRONT_LEFT, GL_RIGHT, GL_BACK_RIGHT}) {
            gl.drawBuffer(name);
            EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_INVALID_OPERATION)) << name;
        }
    }
};

TEST_P(Backends, describeBackendAndDriver) {
    const std::string text = platform_->describe();
    const std::string name = isOsmesa() ? "OSMesa" : GetParam() == "egl" ? "EGL" : "GLX";
    EXPECT_EQ(text.rfind(name, 0), 0u) << text;
    EXPECT_NE(text.find("."), std::string::npos) << text;
}

TEST_P(Backends, probeVersionAndExtensions) {
    for (const bool core : {false, true}) {
        auto probed = gl::probe(*platform_, gl::Api::Desktop, core);
        ASSERT_TRUE(probed) << probed.error().message;
        EXPECT_GE(probed->glVersion, core ? 32 : 21);
        EXPECT_TRUE(probed->has("GL_ARB_vertex_buffer_object") || core);
        EXPECT_TRUE(probed->has("GL_ARB_debug_output"));
        EXPECT_FALSE(probed->has("GL_ARB_debug"));
        EXPECT_FALSE(probed->renderer.empty());
        EXPECT_GE(probed->maxSurfaceSize, 4096);
        // others do not report it
        EXPECT_TRUE(!isMesas() || (probed->version.find("Core") != std::string::npos) == core) << probed->version;
    }
    for (const gl::Api api : {gl::Api::Es1, gl::Api::Es2}) {
        auto probed = gl::probe(*platform_, api, false);
        EXPECT_EQ(probed.ok(), !isOsmesa());
        if (!probed) continue;
        EXPECT_TRUE(probed->es);
        EXPECT_GE(probed->glVersion, api == gl::Api::Es1 ? 11 : 20);
        EXPECT_GT(probed->extensions.size(), 10u);
    }
}

TEST_P(Backends, leaveNoContextCurrentAfterAProbe) {
    ASSERT_TRUE(gl::probe(*platform_, gl::Api::Desktop, false));
    if (!isMesas()) GTEST_SKIP() << "contexts of other drivers stay current until others are";
    const GlFunctions gl(find());
    EXPECT_EQ(gl.getString(GL_VERSION), nullptr);
}

// Like glXCreateContext: the latest compatible version.
TEST_P(Backends, createTheLatestCompatibleVersion) {
    const int latest = gl::probe(*platform_, gl::Api::Desktop, false)->glVersion;
    for (const auto& [major, minor] : {std::pair{1, 0}, {1, 5}, {2, 1}, {3, 0}, {3, 1}, {3, 2}, {4, 5}}) {
        Drawable drawable(*platform_, version(major, minor));
        ASSERT_EQ(drawable.error, "") << major << "." << minor;
        const GlFunctions gl(find());
        const std::string text = reinterpret_cast<const char*>(gl.getString(GL_VERSION));
        GLint profile = 0;
        gl.getIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
        EXPECT_EQ(profile, GL_CONTEXT_COMPATIBILITY_PROFILE_BIT) << major << "." << minor << ": " << text;
        EXPECT_EQ(text.substr(0, 3), std::to_string(latest / 10) + "." + std::to_string(latest % 10));
    }
}

TEST_P(Backends, createCoreProfiles) {
    for (const auto& [major, minor] : {std::pair{3, 1}, {3, 2}, {3, 3}, {4, 5}}) {
        Drawable drawable(*platform_, version(major, minor, true));
        ASSERT_EQ(drawable.error, "");
        const GlFunctions gl(find());
        GLint profile = 0;
        gl.getIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
        EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT) << major << "." << minor;
        gl.begin(GL_TRIANGLES); // removed from core
        EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_INVALID_OPERATION));
    }
}

TEST_P(Backends, passFlagsToTheContext) {
    if (isOsmesa()) {
        gl::ContextConfig forward = version(3, 3, true);
        forward.forwardCompatible = true;
        EXPECT_NE(errorOf(forward).find("forward-compatible"), std::string::npos);
        return;
    }
    gl::ContextConfig config = version(3, 3, true);
    config.forwardCompatible = config.debug = config.robust = true;
    if (const std::string robust = errorOf(config); !robust.empty()) { // Xvfb's GLX has no robust contexts
        EXPECT_EQ(GetParam(), "glx");
        EXPECT_NE(robust.find("robust"), std::string::npos) << robust;
        config.robust = false;
    }
    Drawable drawable(*platform_, config);
    ASSERT_EQ(drawable.error, "");
    const GlFunctions gl(find());
    GLint flags = 0;
    gl.getIntegerv(GL_CONTEXT_FLAGS, &flags);
    EXPECT_TRUE(flags & GL_CONTEXT_FLAG_FORWARD_COMPATIBLE_BIT);
    EXPECT_TRUE(flags & GL_CONTEXT_FLAG_DEBUG_BIT);
    EXPECT_EQ((flags & GL_CONTEXT_FLAG_ROBUST_ACCESS_BIT) != 0, config.robust);
}

TEST_P(Backends, createFramebuffersWithTheRequestedBits) {
    const int depths[][2] = {{16, 0}, {24, 0}, {24, 8}};
    for (const auto& [depth, stencil] : depths)
        for (const int alpha : {0, 8}) {
            gl::ContextConfig config = version(1, 0);
            config.surface.alpha = alpha;
            config.surface.depth = depth;
            config.surface.stencil = stencil;
            Drawable drawable(*platform_, config);
            ASSERT_EQ(drawable.error, "");
            const GlFunctions gl(find());
            auto bits = [&](GLenum name) {
                GLint value = -1;
                gl.getIntegerv(name, &value);
                return value;
            };
            EXPECT_EQ(bits(GL_RED_BITS), 8);
            EXPECT_EQ(bits(GL_ALPHA_BITS), drawable.surface->hiddenAlpha() ? 8 : alpha);
            EXPECT_EQ(bits(GL_DEPTH_BITS), drawable.surface->config().depth);
            EXPECT_EQ(bits(GL_STENCIL_BITS), drawable.surface->config().stencil);
            // others may lack 16 bits
            EXPECT_EQ(isMesas() ? gl::describeDifference(drawable.surface->config(), config.surface) : "", "");
        }
}

TEST_P(Backends, nameImpossibleRequests) {
    gl::SurfaceConfig config;
    config.stereo = true;
    EXPECT_NE(errorOf(config).find("stereo 1"), std::string::npos);
    config = {};
    config.accum = 16;
    EXPECT_EQ(errorOf(config).find("accum 16") == std::string::npos, GetParam() == "glx") << errorOf(config);
    config = {};
    config.width = 20000;
    EXPECT_NE(errorOf(config).find("20000x1"), std::string::npos) << errorOf(config);
    EXPECT_NE(errorOf(version(7, 3, true)).find("OpenGL 7.3 core"), std::string::npos) << errorOf(version(7, 3, true));
    EXPECT_NE(errorOf(version(9, 0, false, gl::Api::Es2)).find("OpenGL ES 9.0"), std::string::npos);
    gl::ContextConfig bits = version(2, 1);
    bits.surface.stereo = true;
    EXPECT_NE(errorOf(bits).find("stereo 1"), std::string::npos);
}

// A program's window on the head may have bits that no window here has: it is drawn anyway, with a message.
TEST_P(Backends, useTheNearestBitsForMissingOnes) {
    gl::ContextConfig config = version(2, 1);
    config.surface.depth = 23;
    config.surface.samples = 77;
    const Drawable drawable(*platform_, config);
    ASSERT_EQ(drawable.error, "");
    const gl::SurfaceConfig& there = drawable.surface->config();
    EXPECT_EQ(there.depth, 24);
    EXPECT_LT(there.samples, 77);
    EXPECT_EQ(gl::describeDifference(there, config.surface),
              "depth 24 instead of 23, samples " + std::to_string(there.samples) + " instead of 77");
    const GlFunctions gl(find());
    GLint bits = 0;
    gl.getIntegerv(GL_DEPTH_BITS, &bits);
    EXPECT_EQ(bits, 24);
    clearRed(gl, 200);
    if (there.samples == 0) { // otherwise reading would need a resolve
        EXPECT_EQ(redOf(gl), 200);
    }
}

// Verifies the table in the README.md of nodes/gl.
TEST_P(Backends, nameTheColorBuffersAsDocumented) {
    for (const bool core : {false, true}) {
        gl::ContextConfig config = version(core ? 3 : 1, core ? 3 : 0, core);
        Drawable drawable(*platform_, config);
        ASSERT_EQ(drawable.error, "");
        const GlFunctions gl(find());
        const gl::ColorBuffers there = drawable.surface->colorBuffers();
        if (there == gl::ColorBuffers::OneNamedBack) {
            oneBufferNamedBack(gl);
            continue;
        }
        const bool single = there == gl::ColorBuffers::OneNamedFront;
        GLint first = 0;
        gl.getIntegerv(GL_DRAW_BUFFER, &first);
        EXPECT_EQ(first, single ? GL_FRONT : GL_BACK);
        for (const GLenum name : {GL_FRONT, GL_BACK, GL_FRONT_LEFT, GL_BACK_LEFT, GL_FRONT_AND_BACK, GL_LEFT}) {
            gl.drawBuffer(GL_FRONT_AND_BACK);
            clearRed(gl, 10);
            gl.drawBuffer(name);
            clearRed(gl, 99);
            const bool both = single || name == GL_FRONT_AND_BACK || name == GL_LEFT;
            gl.readBuffer(GL_FRONT);
            EXPECT_EQ(redOf(gl), both || name == GL_FRONT || name == GL_FRONT_LEFT ? 99 : 10) << name;
            gl.readBuffer(GL_BACK);
            EXPECT_EQ(redOf(gl), both || name == GL_BACK || name == GL_BACK_LEFT ? 99 : 10) << name;
            EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_NO_ERROR)) << name;
        }
        for (const GLenum name : {GL_BACK_RIGHT, GL_RIGHT, GL_AUX0}) {
            gl.drawBuffer(name);
            EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_INVALID_OPERATION)) << name;
        }
        const GLenum back = GL_BACK;
        gl.drawBuffers(1, &back);
        EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_NO_ERROR));
    }
}

// One buffer with two names is drawn to once: blending must not accumulate.
TEST_P(Backends, blendFrontAndBackOnce) {
    Drawable drawable(*platform_, version(1, 0));
    ASSERT_EQ(drawable.error, "");
    if (drawable.surface->colorBuffers() == gl::ColorBuffers::OneNamedBack) GTEST_SKIP() << "one buffer, with one name";
    const GlFunctions gl(find());
    gl.drawBuffer(GL_FRONT_AND_BACK);
    clearRed(gl, 10);
    gl.enable(GL_BLEND);
    gl.blendFunc(GL_ONE, GL_ONE);
    gl.color4f(20 / 255.0f, 0, 0, 0);
    gl.begin(GL_TRIANGLES);
    gl.vertex3f(-3, -3, 0);
    gl.vertex3f(3, -3, 0);
    gl.vertex3f(0, 5, 0);
    gl.end();
    gl.readBuffer(GL_BACK);
    EXPECT_EQ(redOf(gl), 30);
    gl.readBuffer(GL_FRONT);
    EXPECT_EQ(redOf(gl), 30);
}

TEST_P(Backends, acceptOnlyTheNameBackInEs) {
    if (isOsmesa()) return; // has no ES: see nameImpossibleRequests
    Drawable drawable(*platform_, version(3, 0, false, gl::Api::Es2));
    ASSERT_EQ(drawable.error, "");
    const GlFunctions gl(find());
    const GLenum back = GL_BACK, front = GL_FRONT;
    gl.drawBuffers(1, &back);
    gl.readBuffer(GL_BACK);
    clearRed(gl, 60);
    EXPECT_EQ(redOf(gl), 60);
    EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_NO_ERROR));
    gl.drawBuffers(1, &front);
    EXPECT_NE(gl.getError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_P(Backends, shareObjectsInShareGroups) {
    Drawable first(*platform_, version(2, 1));
    ASSERT_EQ(first.error, "");
    const GlFunctions gl(find());
    GLuint texture = 0;
    gl.genTextures(1, &texture);
    gl.bindTexture(GL_TEXTURE_2D, texture);
    const uint32_t texels[4] = {0x11223344, 0x55667788, 0x99aabbcc, 0xddeeff00};
    gl.texImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    gl.finish();
    {
        Drawable second(*platform_, version(2, 1), first.context.get());
        ASSERT_EQ(second.error, "");
        gl.bindTexture(GL_TEXTURE_2D, texture);
        uint32_t read[4] = {};
        gl.getTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, read);
        EXPECT_TRUE(std::equal(texels, texels + 4, read));
    }
    Drawable stranger(*platform_, version(2, 1));
    ASSERT_EQ(stranger.error, "");
    EXPECT_FALSE(gl.isTexture(texture));
}

// A window's new size needs a new surface; the context and its objects stay.
TEST_P(Backends, resizeWithANewSurface) {
    gl::ContextConfig config = version(1, 0);
    Drawable drawable(*platform_, config);
    ASSERT_EQ(drawable.error, "");
    const GlFunctions gl(find());
    GLuint texture = 0;
    gl.genTextures(1, &texture);
    gl.bindTexture(GL_TEXTURE_2D, texture);
    for (const auto& [width, height] : {std::pair{300, 200}, {37, 911}, {1, 1}, {16, 16}}) {
        config.surface.width = width;
        config.surface.height = height;
        auto surface = platform_->createSurface(config.surface);
        ASSERT_TRUE(surface);
        ASSERT_TRUE(platform_->makeCurrent(drawable.context.get(), surface->get(), surface->get()));
        drawable.surface = std::move(surface.value());
        EXPECT_EQ(drawable.surface->width(), width);
        EXPECT_EQ(drawable.surface->height(), height);
        EXPECT_TRUE(gl.isTexture(texture));
        clearRed(gl, 0);
        gl.enable(GL_SCISSOR_TEST);
        gl.scissor(width - 1, height - 1, 50, 50);
        clearRed(gl, 77);
        gl.disable(GL_SCISSOR_TEST);
        const Picture picture = readPicture(gl, config, config.surface);
        const size_t lit = static_cast<size_t>(std::count(picture.color.begin(), picture.color.end(), 77));
        EXPECT_EQ(lit, 1u) << width << "x" << height;
        EXPECT_EQ(picture.color[picture.color.size() - 4], 77) << "upper right corner";
    }
}

TEST_P(Backends, drawToTheCornersOfTheLargestSurface) {
    gl::ContextConfig config = version(1, 0);
    config.surface.width = 16384;
    config.surface.height = 64;
    for (int turn = 0; turn < 2; turn++, std::swap(config.surface.width, config.surface.height)) {
        Drawable drawable(*platform_, config);
        ASSERT_EQ(drawable.error, "");
        const GlFunctions gl(find());
        gl.viewport(0, 0, config.surface.width, config.surface.height);
        clearRed(gl, 5);
        gl.color4f(1, 0, 0, 1);
        gl.begin(GL_POINTS);
        gl.vertex3f(1 - 1.0f / static_cast<float>(config.surface.width),
                    1 - 1.0f / static_cast<float>(config.surface.height), 0);
        gl.end();
        uint8_t pixel[4] = {};
        gl.readPixels(config.surface.width - 1, config.surface.height - 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
        EXPECT_EQ(pixel[0], 255);
        EXPECT_EQ(redOf(gl), 5);
    }
}

TEST_P(Backends, supportDifferentDrawAndReadSurfaces) {
    gl::ContextConfig config = version(1, 0);
    Drawable drawable(*platform_, config);
    ASSERT_EQ(drawable.error, "");
    auto other = platform_->createSurface(config.surface);
    ASSERT_TRUE(other);
    const GlFunctions gl(find());
    clearRed(gl, 40);
    ASSERT_TRUE(platform_->makeCurrent(drawable.context.get(), other->get(), other->get()));
    clearRed(gl, 50);
    auto mixed = platform_->makeCurrent(drawable.context.get(), other->get(), drawable.surface.get());
    if (isOsmesa()) {
        ASSERT_FALSE(mixed);
        EXPECT_NE(mixed.error().message.find("draw to one surface and read from another"), std::string::npos);
        return;
    }
    ASSERT_TRUE(mixed) << mixed.error().message;
    EXPECT_EQ(redOf(gl), 40);
    clearRed(gl, 60); // into the other surface
    EXPECT_EQ(redOf(gl), 40);
    ASSERT_TRUE(platform_->makeCurrent(drawable.context.get(), drawable.surface.get(), other->get()));
    EXPECT_EQ(redOf(gl), 60);
}

// Some EGL platforms grant multisampled surfaces without buffers (Mesa 25.0: the surfaceless one).
TEST_P(Backends, provideBuffersForMultisampledSurfaces) {
    if (isOsmesa()) GTEST_SKIP() << "this backend has no surfaces with samples";
    gl::ContextConfig config = version(2, 1);
    config.surface.samples = 4;
    const Drawable drawable(*platform_, config);
    ASSERT_EQ(drawable.error, "");
    if (drawable.surface->config().samples == 0) GTEST_SKIP() << "this display has no surfaces with samples";
    const GlFunctions gl(find());
    clearRed(gl, 200);
    EXPECT_EQ(redOf(gl), 200) << platform_->describe();
    EXPECT_EQ(gl.getError(), GLenum{GL_NO_ERROR});
}

// Objects can be created before there is a window.
TEST_P(Backends, createContextsWithoutASurface) {
    auto context = platform_->createContext(version(3, 3, true), nullptr);
    ASSERT_TRUE(context);
    auto current = platform_->makeCurrent(context->get(), nullptr, nullptr);
    ASSERT_TRUE(current) << current.error().message;
    const GlFunctions gl(find());
    GLuint texture = 0;
    gl.genTextures(1, &texture);
    gl.bindTexture(GL_TEXTURE_2D, texture);
    EXPECT_TRUE(gl.isTexture(texture));
    EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_P(Backends, serveSurfacesWithDifferentBitsFromOneContext) {
    gl::ContextConfig config = version(1, 0);
    Drawable drawable(*platform_, config);
    ASSERT_EQ(drawable.error, "");
    gl::SurfaceConfig other = config.surface;
    other.alpha = 8;
    other.stencil = 0;
    auto surface = platform_->createSurface(other);
    ASSERT_TRUE(surface);
    auto current = platform_->makeCurrent(drawable.context.get(), surface->get(), surface->get());
    if (isOsmesa()) {
        ASSERT_FALSE(current);
        EXPECT_NE(current.error().message.find("different depths"), std::string::npos);
        return;
    }
    ASSERT_TRUE(current) << current.error().message;
    const GlFunctions gl(find());
    GLint alpha = 0;
    gl.getIntegerv(GL_ALPHA_BITS, &alpha);
    EXPECT_EQ(alpha, 8);
}

// A picture drawn by one thread, read by another from a buffer of the same share group.
TEST_P(Backends, showWritesToReadersInTheShareGroup) {
    gl::ContextConfig config = version(3, 2);
    if (GetParam() != "egl") {
        Drawable drawn(*platform_, version(2, 1));
        ASSERT_EQ(drawn.error, "");
        auto refused = platform_->createReader(version(2, 1), *drawn.context);
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().message.find("use --gl egl"), std::string::npos) << refused.error().message;
        return;
    }
    Drawable drawn(*platform_, config);
    ASSERT_EQ(drawn.error, "");
    auto reader = platform_->createReader(config, *drawn.context);
    ASSERT_TRUE(reader) << reader.error().message;
    const GlFunctions gl(find());
    const auto genBuffers = reinterpret_cast<decltype(&glGenBuffers)>(platform_->getProcAddress("glGenBuffers"));
    const auto mapBufferRange =
        reinterpret_cast<decltype(&glMapBufferRange)>(platform_->getProcAddress("glMapBufferRange"));
    const auto unmapBuffer = reinterpret_cast<decltype(&glUnmapBuffer)>(platform_->getProcAddress("glUnmapBuffer"));
    const auto fenceSync = reinterpret_cast<decltype(&glFenceSync)>(platform_->getProcAddress("glFenceSync"));
    const auto clientWaitSync =
        reinterpret_cast<decltype(&glClientWaitSync)>(platform_->getProcAddress("glClientWaitSync"));
    const auto deleteSync = reinterpret_cast<decltype(&glDeleteSync)>(platform_->getProcAddress("glDeleteSync"));
    const auto flush = reinterpret_cast<decltype(&glFlush)>(platform_->getProcAddress("glFlush"));
    GLuint buffer = 0;
    genBuffers(1, &buffer);
    for (int red = 10; red < 250; red += 60) {
        clearRed(gl, red);
        gl.bindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
        gl.bufferData(GL_PIXEL_PACK_BUFFER, 16 * 16 * 4, nullptr, GL_STREAM_READ);
        gl.readPixels(0, 0, 16, 16, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        gl.bindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        const GLsync done = fenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        flush();
        std::thread other([&] {
            auto entered = (*reader)->enter();
            ASSERT_TRUE(entered) << entered.error().message;
            const GLenum state = clientWaitSync(done, 0, 20'000'000'000);
            EXPECT_TRUE(state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED) << state;
            deleteSync(done);
            gl.bindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
            const auto* pixels =
                static_cast<const uint8_t*>(mapBufferRange(GL_PIXEL_PACK_BUFFER, 0, 16 * 16 * 4, GL_MAP_READ_BIT));
            ASSERT_NE(pixels, nullptr);
            for (size_t i = 0; i < 16 * 16 * 4; i += 4) EXPECT_EQ(pixels[i], red);
            unmapBuffer(GL_PIXEL_PACK_BUFFER);
            (*reader)->leave();
        });
        gl.clear(GL_COLOR_BUFFER_BIT); // this thread continues to draw
        other.join();
    }
    EXPECT_EQ(gl.getError(), static_cast<GLenum>(GL_NO_ERROR));
}

INSTANTIATE_TEST_SUITE_P(Each, Backends, testing::Values("egl", "osmesa", "glx"),
                         [](const auto& chosen) { return chosen.param; });

TEST(OpenPlatform, checksNames) {
    auto none = gl::openPlatform("metal");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("metal"), std::string::npos);
    auto some = gl::openPlatform("auto");
    ASSERT_TRUE(some) << some.error().message;
    EXPECT_EQ((*some)->describe().rfind("EGL", 0), 0u);
}

TEST(OpenPlatform, opensTheNamedGpu) {
    const auto devices = gl::listEglDevices();
    if (devices.empty()) GTEST_SKIP() << "EGL lists no devices";
    const size_t last = devices.size() - 1;
    auto named = gl::openPlatform("egl", {std::to_string(last), 0, 1});
    ASSERT_TRUE(named) << named.error().message;
    EXPECT_NE((*named)->describe().find("device " + std::to_string(last)), std::string::npos) << (*named)->describe();
    auto turn = gl::openPlatform("egl", {"", 5, 6});
    EXPECT_TRUE(turn) << turn.error().message;
    // "auto" does not fall back to OSMesa: the user asked for one GPU.
    for (const char* backend : {"egl", "auto"}) {
        auto none = gl::openPlatform(backend, {"GPU-0", 0, 1});
        ASSERT_FALSE(none);
        EXPECT_EQ(none.error().message.rfind("this machine has no GPU 'GPU-0' (--gpus); its EGL devices: 0", 0), 0u)
            << none.error().message;
    }
}

TEST(OpenPlatform, reportsMissingGlxFeatures) {
    unsetenv("DISPLAY");
    auto none = gl::openPlatform("glx");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("DISPLAY"), std::string::npos);
    setenv("DISPLAY", ":not-there", 1);
    none = gl::openPlatform("glx");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find(":not-there"), std::string::npos);
}

TEST(OpenPlatform, supportsSeveralInstancesOfOneKind) {
    auto first = gl::openPlatform("egl");
    ASSERT_TRUE(first);
    Drawable drawable(**first, version(1, 0));
    {
        auto second = gl::openPlatform("egl");
        ASSERT_TRUE(second);
    }
    ASSERT_TRUE((*first)->makeCurrent(drawable.context.get(), drawable.surface.get(), drawable.surface.get()));
    const GlFunctions gl([&](const char* name) { return (*first)->getProcAddress(name); });
    EXPECT_NE(gl.getString(GL_VERSION), nullptr);
    ASSERT_TRUE((*first)->makeCurrent(nullptr, nullptr, nullptr));
}

} // namespace
} // namespace mural::test
