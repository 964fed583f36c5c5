// Opens backends for tests. Reports those that this machine lacks.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "nodes/gl/gl_platform.hpp"
#include "tests/gl/gl_functions.hpp"
#include "tests/gl/xvfb.hpp"

namespace mural::test {

// Mesa has removed OSMesa: without its library its tests are skipped with a reason. EGL, GLX and Xvfb are required.
class BackendTest : public testing::Test {
protected:
    void open(const std::string& backend) {
        if (backend == "glx" && xvfb_.display().empty()) {
            auto started = xvfb_.start();
            ASSERT_TRUE(started) << started.error().message;
        }
        auto platform = gl::openPlatform(backend);
        if (!platform && backend == "osmesa" && platform.error().message.find("libosmesa6") != std::string::npos)
            GTEST_SKIP() << platform.error().message;
        ASSERT_TRUE(platform) << platform.error().message;
        platform_ = std::move(platform.value());
    }

    FindProc find() {
        return [this](const char* name) { return platform_->getProcAddress(name); };
    }

    Xvfb xvfb_; // outlives the platform
    std::unique_ptr<gl::Platform> platform_;
};

// A current context with a matching surface.
struct Drawable {
    std::unique_ptr<gl::Surface> surface;
    std::unique_ptr<gl::Context> context;
    std::string error;

    Drawable(gl::Platform& platform, const gl::ContextConfig& config, gl::Context* shareWith = nullptr) {
        auto madeSurface = platform.createSurface(config.surface);
        if (!madeSurface) {
            error = madeSurface.error().message;
            return;
        }
        surface = std::move(madeSurface.value());
        auto madeContext = platform.createContext(config, shareWith);
        if (!madeContext) {
            error = madeContext.error().message;
            return;
        }
        context = std::move(madeContext.value());
        if (auto current = platform.makeCurrent(context.get(), surface.get(), surface.get()); !current)
            error = current.error().message;
    }
};

} // namespace mural::test
