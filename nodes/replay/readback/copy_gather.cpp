// Copies from the window and into the window.
//
// Pixels of other tiles arrive before the copy (kOpFillWindow). In exact tiling they are written into the window
// itself. In lean tiling the window's framebuffer has no room for them: they go into a framebuffer object of the copied
// rectangle, and the copy reads from there. A multisampled window must keep its samples, and uses such an object too.
#include <algorithm>

#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

// ---- gathered pixels (lean)

void Replay::forgetGathered() {
    replay::Gathered& g = c_->gathered;
    if (g.framebuffer) gl.glDeleteFramebuffers(1, &g.framebuffer);
    if (g.color) gl.glDeleteTextures(1, &g.color);
    if (g.depthStencil) gl.glDeleteTextures(1, &g.depthStencil);
    g = {};
}

void Replay::gatherForCopy(const PixelViewport& r, GLbitfield plane, const void* pixels, const ColourWords& words) {
    replay::Gathered& g = c_->gathered;
    const bool separate = c_->version >= 30 || c_->api == wire::Api::Desktop;
    const GLenum target = separate ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    if (g.box != r) {
        forgetGathered();
        gl.glGenFramebuffers(1, &g.framebuffer);
        g.box = r;
    }
    GLuint& texture = plane == GL_COLOR_BUFFER_BIT ? g.color : g.depthStencil;
    if (!texture) gl.glGenTextures(1, &texture);
    GLint before = 0;
    gl.glGetIntegerv(GL_TEXTURE_BINDING_2D, &before);
    gl.glBindTexture(GL_TEXTURE_2D, texture);
    if (c_->unpackBuffer) gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    setUnpack(true);
    // As in the window: values count as sRGB only if the program has enabled that.
    const bool srgb = c_->read->config.srgb && c_->api == wire::Api::Desktop && gl.glIsEnabled(GL_FRAMEBUFFER_SRGB);
    const auto srgbOrNot = static_cast<GLint>(srgb ? GL_SRGB8_ALPHA8 : words.storage);
    withPlainTransfer([&] {
        if (plane == GL_COLOR_BUFFER_BIT)
            gl.glTexImage2D(GL_TEXTURE_2D, 0, separate ? srgbOrNot : GL_RGBA, r.w, r.h, 0, GL_RGBA, words.type, pixels);
        else
            gatherDepthStencil(g, plane, pixels);
    });
    if (c_->unpackBuffer) gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER, c_->unpackBuffer);
    gl.glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(before));
    gl.glBindFramebuffer(target, g.framebuffer);
    const GLenum place = plane == GL_COLOR_BUFFER_BIT ? GL_COLOR_ATTACHMENT0 : GL_DEPTH_STENCIL_ATTACHMENT;
    gl.glFramebufferTexture2D(target, place, GL_TEXTURE_2D, texture, 0);
    if (!g.color && c_->api == wire::Api::Desktop)
        gl.glReadBuffer(GL_NONE);
    else if (c_->api == wire::Api::Desktop)
        gl.glReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.glBindFramebuffer(target, name(Kind::Framebuffer, separate ? c_->readFramebuffer : c_->drawFramebuffer));
}

// Depth arrives as 32 bits that contain the window's 24; stencil follows.
void Replay::gatherDepthStencil(replay::Gathered& g, GLbitfield plane, const void* pixels) {
    const auto count = static_cast<size_t>(g.box.area());
    g.depth.resize(count, 0);
    if (plane == GL_DEPTH_BUFFER_BIT) {
        std::memcpy(g.depth.data(), pixels, count * 4);
        for (uint32_t& d : g.depth) d &= 0xffffff00;
    } else {
        for (size_t i = 0; i < count; ++i)
            g.depth[i] = (g.depth[i] & 0xffffff00) | static_cast<const uint8_t*>(pixels)[i];
    }
    gl.glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH24_STENCIL8, g.box.w, g.box.h, 0, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
                    g.depth.data());
}

// Runs a copy that reads `source` of the read framebuffer. `call` receives the offset to add to its coordinates.
void Replay::fromWindow(const PixelViewport& source, const std::function<void(GLint, GLint)>& call) {
    if (c_->readFramebuffer == 0) depthForReading();
    if (c_->readFramebuffer == 0 && c_->read) c_->read->copied = true;
    const PixelViewport box = c_->gathered.box;
    if (!c_->read || (!readsLean() && box.empty()) || c_->readFramebuffer != 0) return call(0, 0);
    if (box.empty() || c_->compiling || !box.contains(intersect(source, c_->read->whole))) {
        const PixelViewport o = readsLean() ? c_->read->region : PixelViewport{};
        return call(-o.x, -o.y);
    }
    const bool separate = c_->version >= 30 || c_->api == wire::Api::Desktop;
    const GLenum target = separate ? GL_READ_FRAMEBUFFER : GL_FRAMEBUFFER;
    gl.glBindFramebuffer(target, c_->gathered.framebuffer);
    call(-box.x, -box.y);
    gl.glBindFramebuffer(target, name(Kind::Framebuffer, separate ? c_->readFramebuffer : c_->drawFramebuffer));
    forgetGathered();
}

// Copies into a level of a texture. `call` receives the position to read from.
void Replay::copyLevel(GLint x, GLint y, GLsizei w, GLsizei h, const std::function<void(GLint, GLint)>& call) {
    fromWindow({x, y, w, h}, [&](GLint dx, GLint dy) { call(moved(x, -dx), moved(y, -dy)); });
}

// ---- from framebuffer to framebuffer

namespace {
PixelViewport between(GLint x0, GLint y0, GLint x1, GLint y1) {
    const GLint x = std::min(x0, x1), y = std::min(y0, y1);
    const auto size = [](GLint a, GLint b) {
        return static_cast<int32_t>(std::min<int64_t>(std::abs(int64_t{a} - b), INT32_MAX));
    };
    return {x, y, size(x0, x1), size(y0, y1)};
}
} // namespace

void Replay::glBlitFramebuffer(GLint srcX0, GLint srcY0, GLint srcX1, GLint srcY1, GLint dstX0, GLint dstY0,
                               GLint dstX1, GLint dstY1, GLbitfield mask, GLenum filter) {
    if (!gl.glBlitFramebuffer) return;
    const PixelViewport o = origin();
    fromWindow(between(srcX0, srcY0, srcX1, srcY1), [&](GLint dx, GLint dy) {
        withoutTile([&] {
            gl.glBlitFramebuffer(moved(srcX0, -dx), moved(srcY0, -dy), moved(srcX1, -dx), moved(srcY1, -dy),
                                 moved(dstX0, o.x), moved(dstY0, o.y), moved(dstX1, o.x), moved(dstY1, o.y), mask,
                                 filter);
        });
    });
    if ((mask & GL_COLOR_BUFFER_BIT) && hidesAlpha()) makeOpaque();
}

// Equivalent to a blit with both framebuffers bound. Implemented that way in lean tiling, and after pixels were
// gathered.
void Replay::glBlitNamedFramebuffer(GLuint readFramebuffer, GLuint drawFramebuffer, GLint srcX0, GLint srcY0,
                                    GLint srcX1, GLint srcY1, GLint dstX0, GLint dstY0, GLint dstX1, GLint dstY1,
                                    GLbitfield mask, GLenum filter) {
    if (!gl.glBlitNamedFramebuffer) return;
    if (readFramebuffer == 0) depthForReading();
    if (!config_.lean && c_->gathered.box.empty()) {
        return withoutTile([&] {
            gl.glBlitNamedFramebuffer(name(Kind::Framebuffer, readFramebuffer),
                                      name(Kind::Framebuffer, drawFramebuffer), srcX0, srcY0, srcX1, srcY1, dstX0,
                                      dstY0, dstX1, dstY1, mask, filter);
        });
    }
    const GLuint readBefore = c_->readFramebuffer, drawBefore = c_->drawFramebuffer;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, readFramebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, drawFramebuffer);
    glBlitFramebuffer(srcX0, srcY0, srcX1, srcY1, dstX0, dstY0, dstX1, dstY1, mask, filter);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, readBefore);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, drawBefore);
}

// The raster position, the destination of the copy, has already moved with the viewport.
void Replay::glCopyPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum type) {
    if (!gl.glCopyPixels) return;
    fromWindow({x, y, width, height}, [&](GLint dx, GLint dy) {
        withoutTile([&] { gl.glCopyPixels(moved(x, -dx), moved(y, -dy), width, height, type); });
    });
}

} // namespace mural
