// A windowless GL context for the tests of sizes, and shared helpers.
#pragma once

#include <cstdint>
#include <vector>

#define GL_GLEXT_PROTOTYPES 1
#include <GL/gl.h>
#include <GL/glext.h>

#include <gtest/gtest.h>

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural::sizes {

enum class TestApi { Compatibility, Es3, Es1 };

// Current on the calling thread during its lifetime, on EGL surfaceless. valid() is false if it could not be created.
class TestContext {
public:
    explicit TestContext(TestApi api);
    ~TestContext();
    TestContext(const TestContext&) = delete;
    TestContext& operator=(const TestContext&) = delete;

    [[nodiscard]] bool valid() const { return context_ != nullptr; }

private:
    void* display_ = nullptr;
    void* context_ = nullptr;
};

// Clears all errors, and returns whether there was one.
bool takeErrors();

enum class Direction { Unpack, Pack };
void setPixelStore(Direction direction, const PixelStore& store, TestApi api);
PixelStore tightStore();

void (*procAddress(const char* name))();

// All enum values known as format or type.
std::vector<GLenum> knownFormats();
const std::vector<GLenum>& knownTypes();

// A texture of colour, depth or indices as a framebuffer of 32×32; false if GL lacks it.
class TestFramebuffer {
public:
    TestFramebuffer(GLenum internalformat, GLenum format, GLenum type);
    ~TestFramebuffer();
    TestFramebuffer(const TestFramebuffer&) = delete;
    TestFramebuffer& operator=(const TestFramebuffer&) = delete;
    [[nodiscard]] bool complete() const { return complete_; }
    static constexpr int kSize = 32;

private:
    GLuint texture_ = 0;
    GLuint framebuffer_ = 0;
    bool complete_ = false;
};

} // namespace mural::sizes
