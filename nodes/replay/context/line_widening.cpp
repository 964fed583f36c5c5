// Lean tiles that grow to the window's size. If every node has to draw everything
// (interposer/memory/shader_writes.hpp), the framebuffer of a lean tile is too small. Windows then get framebuffers of
// their own size.
#include <algorithm>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

// Switches the window to exact tiling and preserves the tile's content. A raster position and a polygon stipple that
// were set before keep the tile's coordinates.
void Replay::widenToWindow(Window& w) {
    w.widens = false;
    const PixelViewport size = surfaceOf(w, false);
    auto made = platform_->createSurface(surfaceConfig(w.config, size.w, size.h));
    if (!made) {
        log::warning(
            log::Topic::Replay,
            "fragment shaders that write to memory need a framebuffer of the whole window (" +
                std::to_string(w.whole.w) + "x" + std::to_string(w.whole.h) +
                "), which cannot be created; their memory contains only this node's part: " + made.error().message);
        return;
    }
    const std::unique_ptr<gl::Surface> tile = std::exchange(w.surface, std::move(*made));
    w.lean = false;
    dropFront(w);
    if (tile && gl.glBlitFramebuffer) withQueriesSuspended([&] { copyTile(w, *tile); });
    (void)bindSurfaces();
}

// Copies the tile into the window's new framebuffer, independently of the program's state. Makes the new one current
// and reselects buffers; the caller restores the scissor.
void Replay::copyTile(const Window& w, gl::Surface& from) {
    if (!platform_->makeCurrent(c_->context.get(), w.surface.get(), &from)) return;
    const bool desktop = c_->api == wire::Api::Desktop;
    gl.glBindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.glDisable(GL_SCISSOR_TEST);
    const bool srgb = desktop && gl.glIsEnabled(GL_FRAMEBUFFER_SRGB);
    if (srgb) gl.glDisable(GL_FRAMEBUFFER_SRGB);
    GLboolean deep = GL_TRUE; // the content of other tiles is unknown: the program's clear depth is a good guess
    gl.glGetBooleanv(GL_DEPTH_WRITEMASK, &deep);
    gl.glDepthMask(GL_TRUE);
    gl.glClear(GL_DEPTH_BUFFER_BIT);
    gl.glDepthMask(deep);
    const PixelViewport& r = w.region;
    const auto blit = [&](GLbitfield planes) {
        gl.glBlitFramebuffer(0, 0, r.w, r.h, r.x, r.y, r.right(), r.top(), planes, GL_NEAREST);
    };
    for (const GLenum buffer : {GL_FRONT, GL_BACK}) {
        if (buffer == GL_FRONT ? !desktop : desktop && (from.singleBuffered() || !w.config.doubleBuffer)) continue;
        if (desktop) gl.glReadBuffer(windowBuffer(buffer, &w));
        if (desktop) gl.glDrawBuffer(windowBuffer(buffer, &w));
        blit(GL_COLOR_BUFFER_BIT);
    }
    blit(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    if (desktop) gl.glReadBuffer(windowBuffer(c_->readBuffer0, &w));
    if (desktop) gl.glDrawBuffer(windowBuffer(c_->drawBuffer0, &w));
    if (srgb) gl.glEnable(GL_FRAMEBUFFER_SRGB);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, name(Kind::Framebuffer, c_->readFramebuffer));
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(Kind::Framebuffer, c_->drawFramebuffer));
}

} // namespace mural
