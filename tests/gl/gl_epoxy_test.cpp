// libepoxy resolves the driver's functions once per process, in the context current at the first call of a command.
// Neither the order of contexts nor the names in a stream may matter. ctest runs each test in its own process, so each
// starts with an unresolved libepoxy.
#include <array>
#include <dlfcn.h>

#include "tests/gl/backend_test.hpp"
#include "tests/gl/scene.hpp"

namespace mural::test {
namespace {

using Proc = gl::Proc;

gl::ContextConfig kind(gl::Api api, int major, int minor, bool core = false) {
    gl::ContextConfig config;
    config.api = api;
    config.major = major;
    config.minor = minor;
    config.core = core;
    config.surface.width = 97;
    config.surface.height = 61;
    return config;
}

using Kinds = std::vector<gl::ContextConfig>;
const Kinds& esFirst() {
    static const Kinds kinds{kind(gl::Api::Es1, 1, 1), kind(gl::Api::Es2, 2, 0), kind(gl::Api::Es2, 3, 0),
                             kind(gl::Api::Desktop, 1, 0), kind(gl::Api::Desktop, 4, 5, true)};
    return kinds;
}
Kinds desktopFirst() { return {esFirst().rbegin(), esFirst().rend()}; }

bool isEpoxys(Proc proc) {
    Dl_info info{};
    return proc && dladdr(reinterpret_cast<void*>(proc), &info) &&
           std::string(info.dli_fname).find("libepoxy") != std::string::npos;
}

// The driver's functions, without libepoxy.
FindProc driversOwn(const std::string& backend) {
    const bool glx = backend == "glx";
    void* library = dlopen(glx ? "libGLX.so.0" : "libEGL.so.1", RTLD_NOW);
    const auto loader =
        reinterpret_cast<Proc (*)(const char*)>(dlsym(library, glx ? "glXGetProcAddressARB" : "eglGetProcAddress"));
    return [loader](const char* name) { return loader(name); };
}

class Epoxy : public BackendTest {
protected:
    void TearDown() override {
        if (!platform_) return;
        EXPECT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
    }

    // Draws in a context of each kind, with libepoxy first. The pictures must equal the driver's own.
    void drawInAll(const std::string& backend, const Kinds& kinds) {
        open(backend);
        if (HasFatalFailure()) return;
        for (const gl::ContextConfig& config : kinds) {
            const std::string what =
                backend + ", kind " + std::to_string(static_cast<int>(config.api)) + " " + std::to_string(config.major);
            Picture pictures[2];
            for (const bool own : {false, true}) {
                Drawable drawable(*platform_, config);
                ASSERT_EQ(drawable.error, "") << what;
                pictures[own] = drawScene(own ? driversOwn(backend) : find(), config, config.surface);
                ASSERT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
            }
            EXPECT_EQ(pictures[0].error, "") << what;
            EXPECT_GT(countColors(pictures[0]), 20u) << what;
            EXPECT_EQ(difference(pictures[1], pictures[0]), "") << what;
        }
    }
};

TEST_F(Epoxy, providesTheCommandsOfEglAndGlx) {
    for (const char* backend : {"egl", "glx"}) {
        open(backend);
        Drawable drawable(*platform_, kind(gl::Api::Desktop, 1, 0));
        for (const char* name : {"glRectdv", "glGetShaderSource", "glCombinerInputNV", "glTexEnvxv"})
            EXPECT_TRUE(isEpoxys(platform_->getProcAddress(name))) << backend << " " << name;
        ASSERT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
    }
}

// Names that libepoxy may confuse, commands allowed between Begin and End, and commands unknown to libepoxy.
TEST_F(Epoxy, leavesOtherCommandsToTheDriver) {
    open("egl");
    for (const char* name : {"glBindVertexArray", "glBindFramebufferEXT", "glAttachObjectARB", "glBlendBarrier",
                             "glBegin", "glEnd", "glVertexAttrib4Nub", "glColor3hNV", "glTexCoordP2uiv",
                             "glShadingRateQCOM", "glNoSuchCommand", "eglGetError"})
        EXPECT_FALSE(isEpoxys(platform_->getProcAddress(name))) << name;
}

TEST_F(Epoxy, drawsTheDriversPicturesWithEsFirst) { drawInAll("egl", esFirst()); }

TEST_F(Epoxy, drawsTheDriversPicturesWithDesktopFirst) { drawInAll("egl", desktopFirst()); }

TEST_F(Epoxy, drawsTheDriversPicturesInEglThenGlx) {
    drawInAll("egl", desktopFirst());
    drawInAll("glx", esFirst());
}

TEST_F(Epoxy, drawsTheDriversPicturesInGlxThenEgl) {
    drawInAll("glx", desktopFirst());
    drawInAll("egl", esFirst());
}

// libepoxy itself would abort the process ("No provider of ... found").
TEST_F(Epoxy, survivesACommandThatTheDriverLacks) {
    constexpr std::array kLacking{"glResizeBuffersMESA", "glFlushVertexArrayRangeNV", "glFinishTextureSUNX",
                                  "glSwapAPPLE",         "glFlushRasterSGIX",         "glEndOcclusionQueryNV",
                                  "glVDPAUFiniNV"};
    size_t next = 0;
    for (const char* backend : {"egl", "glx"}) {
        open(backend);
        for (const gl::ContextConfig& config : esFirst()) {
            Drawable drawable(*platform_, config);
            ASSERT_EQ(drawable.error, "");
            const Proc first = platform_->getProcAddress(kLacking[next++ % kLacking.size()]);
            ASSERT_NE(first, nullptr);
            first(); // each in another kind of context
            for (const char* name : kLacking) platform_->getProcAddress(name)();
            const GlFunctions gl(find());
            EXPECT_NE(gl.getString(GL_VERSION), nullptr);
            ASSERT_TRUE(platform_->makeCurrent(nullptr, nullptr, nullptr));
        }
    }
}

} // namespace
} // namespace mural::test
