// The guarantee of the platforms: bit-identical to the picture of a native window on the same machine.
#include <cstring>

#include <gtest/gtest.h>

#include "tests/gl/backend_test.hpp"
#include "tests/gl/native_window.hpp"

namespace mural::test {
namespace {

struct Case {
    const char* name;
    gl::ContextConfig context; // surface: the bits
    bool osmesa;               // OSMesa supports these bits and this kind of context
    bool egl = true;
};

gl::ContextConfig make(gl::Api api, int major, int minor, bool core) {
    gl::ContextConfig config;
    config.api = api;
    config.major = major;
    config.minor = minor;
    config.core = core;
    config.surface.width = 331; // no multiple of any tile
    config.surface.height = 217;
    return config;
}

gl::ContextConfig compat(int alpha, int depth, int stencil, int samples = 0, int accum = 0) {
    gl::ContextConfig config = make(gl::Api::Desktop, 1, 0, false);
    config.surface.alpha = alpha;
    config.surface.depth = depth;
    config.surface.stencil = stencil;
    config.surface.samples = samples;
    config.surface.accum = accum;
    return config;
}

gl::ContextConfig withSamples(gl::ContextConfig config, int samples) {
    config.surface.samples = samples;
    return config;
}

gl::ContextConfig withSrgb(gl::ContextConfig config) {
    config.surface.srgb = true;
    return config;
}

const Case kCases[] = {
    {"rgbDepth24Stencil8", compat(0, 24, 8), true},
    {"rgbaDepth24Stencil8", compat(8, 24, 8), true},
    {"rgbDepth24", compat(0, 24, 0), true},
    {"rgbaDepth16", compat(8, 16, 0), true},
    {"rgbaDepth32", compat(8, 32, 0), false},
    {"rgbaNoDepth", compat(8, 0, 0), false},
    {"rgbNoDepth", compat(0, 0, 0), false},
    {"rgbMultisampled", compat(0, 24, 8, 4), false},
    {"rgbaMultisampled", compat(8, 24, 8, 4), false},
    {"rgbaAccumulation", compat(8, 24, 8, 0, 16), false, false},
    {"version21", make(gl::Api::Desktop, 2, 1, false), true},
    {"version32Compatibility", make(gl::Api::Desktop, 3, 2, false), true},
    {"version33Core", make(gl::Api::Desktop, 3, 3, true), true},
    {"version45CoreMultisampled", withSamples(make(gl::Api::Desktop, 4, 5, true), 4), false},
    {"es1", make(gl::Api::Es1, 1, 1, false), false},
    {"es2", make(gl::Api::Es2, 2, 0, false), false},
    {"es32Multisampled", withSamples(make(gl::Api::Es2, 3, 2, false), 4), false},
    {"es3Srgb", withSrgb(make(gl::Api::Es2, 3, 0, false)), false},
    {"coreSrgb", withSrgb(make(gl::Api::Desktop, 3, 3, true)), false},
};

void PrintTo(const Case& shown, std::ostream* out) { *out << shown.name; }

class WindowEquality : public BackendTest, public testing::WithParamInterface<Case> {
protected:
    Picture drawNative() {
        Picture picture;
        auto window = openGlxWindow(GetParam().context);
        if (!window) {
            picture.error = window.error().message;
            return picture;
        }
        picture = drawScene((*window)->find(), GetParam().context, GetParam().context.surface);
        checkShown(**window, picture);
        return picture;
    }

    // Verifies that the read picture is on the screen.
    void checkShown(NativeWindow& window, const Picture& picture) {
        const std::vector<uint32_t> shown = window.show();
        ASSERT_EQ(shown.size() * 4, picture.color.size());
        size_t differing = 0;
        int largest = 0;
        for (int y = 0; y < picture.height; y++)
            for (int x = 0; x < picture.width; x++) {
                const uint8_t* c =
                    &picture.color[static_cast<size_t>((picture.height - 1 - y) * picture.width + x) * 4];
                const uint32_t rgb = static_cast<uint32_t>(c[0]) << 16 | static_cast<uint32_t>(c[1]) << 8 | c[2];
                const uint32_t seen = shown[static_cast<size_t>(y * picture.width + x)];
                if (seen != rgb) differing++;
                for (int shift : {0, 8, 16})
                    largest = std::max(largest, std::abs(static_cast<int>(seen >> shift & 255) -
                                                         static_cast<int>(rgb >> shift & 255)));
            }
        EXPECT_EQ(differing, 0u) << "pixels on the screen differ from those read back, by at most " << largest;
    }

    void compare(const std::string& backend, const Picture& native) {
        platform_.reset();
        open(backend);
        if (!platform_) return; // failed or skipped, with a message
        Picture picture;
        {
            Drawable drawable(*platform_, GetParam().context);
            ASSERT_EQ(drawable.error, "") << backend;
            picture =
                drawScene(find(), GetParam().context, GetParam().context.surface, drawable.surface->hiddenAlpha());
            ASSERT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
        }
        EXPECT_EQ(difference(native, picture), "") << backend << " against a native window";
    }
};

TEST_P(WindowEquality, holdsForEveryBackend) {
    auto started = xvfb_.start();
    ASSERT_TRUE(started) << started.error().message;
    const Picture native = drawNative();
    ASSERT_EQ(native.error, "");
    ASSERT_GT(countColors(native), 500u) << "the scene shows nothing";
    compare("glx", native);
    if (GetParam().egl) compare("egl", native);
    if (GetParam().osmesa) compare("osmesa", native);
}

INSTANTIATE_TEST_SUITE_P(Configs, WindowEquality, testing::ValuesIn(kCases),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

class EglWindowEquality : public BackendTest, public testing::WithParamInterface<Case> {};

// GLES programs and toolkits with Wayland support create their windows with EGL.
TEST_P(EglWindowEquality, holdsForEglPbuffers) {
    auto started = xvfb_.start();
    ASSERT_TRUE(started) << started.error().message;
    const gl::ContextConfig& config = GetParam().context;
    Picture native;
    {
        auto window = openEglWindow(config);
        ASSERT_TRUE(window) << window.error().message;
        native = drawScene((*window)->find(), config, config.surface);
    }
    ASSERT_GT(countColors(native), 500u) << "the scene shows nothing";
    open("egl");
    ASSERT_NE(platform_, nullptr);
    Drawable drawable(*platform_, config);
    ASSERT_EQ(drawable.error, "");
    EXPECT_EQ(difference(native, drawScene(find(), config, config.surface)), "");
    ASSERT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
}

const Case kEglCases[] = {
    {"compatibility", make(gl::Api::Desktop, 1, 0, false), false},
    {"es1", make(gl::Api::Es1, 1, 0, false), false},
    {"es2", make(gl::Api::Es2, 2, 0, false), false},
    {"es3Multisampled", withSamples(make(gl::Api::Es2, 3, 0, false), 4), false},
};

INSTANTIATE_TEST_SUITE_P(Configs, EglWindowEquality, testing::ValuesIn(kEglCases),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

TEST(Difference, findsOneBitInEachPlane) {
    Picture one{2, 1, std::vector<uint8_t>(8, 5), {}, {1, 2}, {3, 4}, ""};
    EXPECT_EQ(difference(one, one), "");
    Picture other = one;
    other.color[6] = 4;
    EXPECT_NE(difference(one, other).find("colour: 1 pixels differ, by at most 1.0"), std::string::npos);
    other = one;
    other.depth[1] = 3;
    EXPECT_NE(difference(one, other), "");
    other = one;
    other.stencil.clear();
    EXPECT_NE(difference(one, other), "");
}

} // namespace
} // namespace mural::test
