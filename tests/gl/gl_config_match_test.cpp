// The choice of the driver's configuration for a requested one, and release of surfaces.
#include "nodes/gl/config_match.hpp"

#include <gtest/gtest.h>

#include "nodes/gl/dynamic_library.hpp"
#include "nodes/gl/egl_display.hpp"
#include "nodes/gl/gl_info.hpp"

namespace mural::gl {
namespace {

ConfigCandidate candidate(int alpha, int depth, int samples, int rank = 0) {
    ConfigCandidate made;
    made.bits.alpha = alpha;
    made.bits.depth = depth;
    made.bits.samples = samples;
    made.rank = rank;
    return made;
}

TEST(ConfigMatch, takesEqualBitsAndNotMore) {
    const std::vector<ConfigCandidate> all{candidate(8, 32, 0), candidate(0, 32, 0), candidate(0, 24, 4),
                                           candidate(0, 24, 0)};
    auto index = matchConfig("X", all, SurfaceConfig());
    ASSERT_TRUE(index);
    EXPECT_EQ(*index, 3u);
}

TEST(ConfigMatch, takesTheLowestRankThenTheFirst) {
    const std::vector<ConfigCandidate> all{candidate(0, 24, 0, 2), candidate(0, 24, 0, 1), candidate(0, 24, 0, 1)};
    EXPECT_EQ(matchConfig("X", all, SurfaceConfig()).value(), 1u);
}

TEST(ConfigMatch, treatsOneSampleAsNoMultisampling) {
    EXPECT_TRUE(matchConfig("X", {candidate(0, 24, 1)}, SurfaceConfig()));
}

TEST(ConfigMatch, namesTheRequestAndTheCandidatesInErrors) {
    SurfaceConfig requested;
    requested.accum = 2;
    auto index = matchConfig("EGL", {candidate(0, 24, 0), candidate(0, 24, 4), candidate(8, 24, 8)}, requested);
    ASSERT_FALSE(index);
    EXPECT_NE(index.error().message.find("EGL"), std::string::npos);
    EXPECT_NE(index.error().message.find("accum 2 (it has 0)"), std::string::npos) << index.error().message;
    EXPECT_FALSE(matchConfig("EGL", {}, requested));
}

// A window of 10 bits per channel and 2 of alpha, where the driver has pbuffers of 8 only.
TEST(ConfigMatch, takesOtherAlphaOnlyWhereBothHaveOne) {
    SurfaceConfig requested;
    requested.alpha = 2;
    EXPECT_EQ(matchConfig("X", {candidate(0, 24, 0), candidate(8, 24, 0)}, requested).value(), 1u);
    EXPECT_FALSE(matchConfig("X", {candidate(0, 24, 0)}, requested));
    requested.alpha = 0;
    EXPECT_FALSE(matchConfig("X", {candidate(8, 24, 0)}, requested));
}

TEST(ConfigMatch, takesTheNearestCandidateForMissingBits) {
    const std::vector<ConfigCandidate> all{candidate(0, 0, 0), candidate(0, 16, 8), candidate(0, 24, 4),
                                           candidate(0, 24, 2)};
    const auto taken = [&](int depth, int samples) {
        SurfaceConfig requested;
        requested.depth = depth;
        requested.samples = samples;
        return matchConfig("X", all, requested).value();
    };
    EXPECT_EQ(taken(32, 4), 2u); // the most that there is
    EXPECT_EQ(taken(20, 3), 2u); // the least that has more, of each
    EXPECT_EQ(taken(12, 0), 1u); // depth goes before samples
    EXPECT_EQ(taken(24, 0), 3u);
    EXPECT_EQ(taken(24, 16), 2u);
}

TEST(ConfigMatch, describesDifferences) {
    SurfaceConfig requested, there;
    EXPECT_EQ(describeDifference(there, requested), "");
    requested.depth = 32;
    requested.samples = 4;
    there.width = 99; // the width is not compared
    EXPECT_EQ(describeDifference(there, requested), "depth 24 instead of 32, samples 0 instead of 4");
    const ConfigCandidate taken = candidate(0, 24, 0);
    requested.width = 77;
    EXPECT_EQ(bitsOf(taken, requested).width, 77);
    EXPECT_EQ(bitsOf(taken, requested).depth, 24);
}

TEST(ConfigMatch, comparesEveryAttribute) {
    const std::vector<int SurfaceConfig::*> numbers{
        &SurfaceConfig::red,   &SurfaceConfig::green,   &SurfaceConfig::blue,    &SurfaceConfig::alpha,
        &SurfaceConfig::depth, &SurfaceConfig::stencil, &SurfaceConfig::samples, &SurfaceConfig::accum};
    for (auto number : numbers) {
        SurfaceConfig requested;
        requested.*number += 2;
        EXPECT_EQ(static_cast<bool>(matchConfig("X", {ConfigCandidate()}, requested)),
                  number != &SurfaceConfig::alpha && number != &SurfaceConfig::accum);
        EXPECT_NE(describeDifference(SurfaceConfig(), requested), "");
        EXPECT_FALSE(sameBits(requested, SurfaceConfig()));
    }
    SurfaceConfig srgb, stereo, wide;
    srgb.srgb = stereo.stereo = true;
    wide.width = 99;
    EXPECT_FALSE(sameBits(srgb, SurfaceConfig()));
    EXPECT_FALSE(sameBits(stereo, SurfaceConfig()));
    EXPECT_TRUE(sameBits(wide, SurfaceConfig()));
}

TEST(ConfigMatch, limitsSizes) {
    SurfaceConfig requested;
    requested.width = requested.height = kMaxSurfaceSize;
    EXPECT_TRUE(checkSize("X", requested, kMaxSurfaceSize));
    requested.height = kMaxSurfaceSize + 1;
    EXPECT_FALSE(checkSize("X", requested, kMaxSurfaceSize));
    requested.height = 0;
    EXPECT_FALSE(checkSize("X", requested, kMaxSurfaceSize));
}

TEST(VersionRequest, setsAProfileFrom31On) {
    ContextConfig requested;
    EXPECT_FALSE(versionRequest(requested).profile);
    requested.major = 3;
    EXPECT_FALSE(versionRequest(requested).profile);
    requested.minor = 1;
    EXPECT_TRUE(versionRequest(requested).profile);
    EXPECT_EQ(versionRequest(requested).minor, 2);
    requested.minor = 3;
    EXPECT_TRUE(versionRequest(requested).profile);
    EXPECT_EQ(versionRequest(requested).minor, 3);
    requested.api = Api::Es2;
    EXPECT_FALSE(versionRequest(requested).profile);
}

TEST(DynamicLibrary, reportsAMissingLibraryAndItsPackage) {
    auto library = DynamicLibrary::open({"libmural-not-there.so.1", "libmural-not-there.so"}, "mural-not-there");
    ASSERT_FALSE(library);
    EXPECT_NE(library.error().message.find("libmural-not-there.so.1"), std::string::npos);
    EXPECT_NE(library.error().message.find("install the package mural-not-there"), std::string::npos);
}

TEST(DynamicLibrary, takesTheFirstThatIsThere) {
    auto library = DynamicLibrary::open({"libmural-not-there.so", "libc.so.6"}, "libc6");
    ASSERT_TRUE(library);
    EXPECT_EQ(library->name(), "libc.so.6");
    int (*found)(const char*) = nullptr;
    EXPECT_TRUE(library->load(found, "puts"));
    EXPECT_FALSE(library->load(found, "mural_not_there"));
}

std::vector<std::pair<char, void*>>& destroyed() {
    static std::vector<std::pair<char, void*>> all;
    return all;
}

EGLBoolean destroySurface(EGLDisplay, EGLSurface surface) {
    destroyed().emplace_back('s', surface);
    return EGL_TRUE;
}

EGLBoolean destroyContext(EGLDisplay, EGLContext context) {
    destroyed().emplace_back('c', context);
    return EGL_TRUE;
}

// The driver uses the current surfaces when the next ones become current, so they must still exist then.
TEST(EglDeferredObjects, areDestroyedOnceOnRequest) {
    int one = 0, other = 0;
    {
        EglDisplayState state;
        state.egl.destroySurface = destroySurface;
        state.egl.destroyContext = destroyContext;
        state.deferredObjects.addSurface(&one);
        state.deferredObjects.addContext(&other);
        EXPECT_TRUE(destroyed().empty());
        state.deferredObjects.destroy(state.egl, state.display);
        EXPECT_EQ(destroyed(), (std::vector<std::pair<char, void*>>{{'c', &other}, {'s', &one}}));
        state.deferredObjects.destroy(state.egl, state.display);
        EXPECT_EQ(destroyed().size(), 2u);
        state.deferredObjects.addSurface(&other);
    }
    EXPECT_EQ(destroyed().size(), 3u) << "the display destroys all of them at its end";
}

TEST(GlVersion, isReadFromEveryForm) {
    EXPECT_EQ(parseGlVersion("4.5 (Compatibility Profile) Mesa 22.3.6"), 45);
    EXPECT_EQ(parseGlVersion("OpenGL ES-CM 1.1 Mesa 22.3.6"), 11);
    EXPECT_EQ(parseGlVersion("OpenGL ES 3.2 NVIDIA 535.1"), 32);
    EXPECT_EQ(parseGlVersion(""), 0);
    EXPECT_EQ(parseGlVersion("none"), 0);
    EXPECT_EQ(parseMesaVersion("4.5 (Compatibility Profile) Mesa 22.3.6"), 22);
    EXPECT_EQ(parseMesaVersion("4.6 Mesa 25.0.7-2 (git)"), 25);
    EXPECT_EQ(parseMesaVersion("OpenGL ES 3.2 NVIDIA 535.1"), 0);
    EXPECT_EQ(parseMesaVersion("4.5 Mesa "), 0);
}

} // namespace
} // namespace mural::gl
