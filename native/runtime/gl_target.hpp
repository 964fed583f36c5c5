// The context of a renderer and the framebuffer that its tasks draw to. Used by the player's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <mural/render.hpp>

#include "native/runtime/gl_calls.hpp"
#include "nodes/gl/gl_platform.hpp"

namespace mural::native {

class GlTarget {
public:
    // Creates the context, and makes it current with a small framebuffer. Errors: the driver has no such context.
    static Result<std::unique_ptr<GlTarget>> open(std::unique_ptr<gl::Platform> platform, const GlWish& wish);
    GlTarget(const GlTarget&) = delete;
    GlTarget& operator=(const GlTarget&) = delete;
    ~GlTarget();

    [[nodiscard]] const GlCalls& gl() const { return gl_; }
    [[nodiscard]] gl::Proc procAddress(const char* name) { return platform_->getProcAddress(name); }
    [[nodiscard]] int samples() const { return surface_->config().samples; }
    [[nodiscard]] int depthBits() const { return isHalfFloat_ ? kDepthBitsBesideHalfFloats : surface_->config().depth; }
    [[nodiscard]] bool isHalfFloat() const { return isHalfFloat_; }

    // Makes the framebuffer at least as large as `size`. Its content is undefined after a change. Errors: out of
    // memory.
    Result<void> resize(const PixelViewport& size);

    // Selects framebuffer, draw buffer and masks for a task.
    void apply(const PixelViewport& viewport, const PixelViewport& scissor) const;
    [[nodiscard]] unsigned framebuffer() const { return framebuffer_; }

    // Reads colours of the framebuffer: rows bottom first, tightly packed. format: GL_BGRA or GL_RGBA. Half floats are
    // clamped and rounded.
    void readColour(const PixelViewport& box, GLenum format, void* into) const;
    // Half floats R G B A. Requires isHalfFloat().
    void readHalfFloats(const PixelViewport& box, uint32_t* into) const;
    void readDepth(const PixelViewport& box, uint32_t* into) const;
    // Writes colours R G B A into the framebuffer.
    void writeColour(const PixelViewport& box, const uint32_t* rgba) const;
    void writeHalfFloats(const PixelViewport& box, const uint32_t* rgba) const;

private:
    static constexpr int kDepthBitsBesideHalfFloats = 24;

    GlTarget(std::unique_ptr<gl::Platform> platform, gl::SurfaceConfig config, bool isHalfFloat)
        : platform_(std::move(platform)), config_(config), isHalfFloat_(isHalfFloat) {}
    Result<void> resizeSurface(const PixelViewport& size);
    Result<void> resizeTextures(const PixelViewport& size);
    void write(const PixelViewport& box, GLint format, GLenum type, const void* rgba) const;
    void prepareRead() const;
    [[nodiscard]] GLenum colourBuffer() const;

    std::unique_ptr<gl::Platform> platform_;
    gl::SurfaceConfig config_; // of the surface
    std::unique_ptr<gl::Context> context_;
    std::unique_ptr<gl::Surface> surface_;
    GlCalls gl_;
    const bool isHalfFloat_;
    GLuint framebuffer_ = 0, colour_ = 0, depth_ = 0; // with half floats: the framebuffer object and its textures
    int32_t width_ = 0, height_ = 0;                  // of these textures
};

} // namespace mural::native
