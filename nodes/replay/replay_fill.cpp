// Depth and stencil of other tiles, put into windows of core and ES contexts: core contexts
// have no glDrawPixels, so a context of another kind draws into the same window.
#include "nodes/replay/replay.hpp"

namespace mural {

gl::Context* Replay::fillerOf(Window& w) {
    if (w.filler) return w.filler.get();
    gl::ContextConfig wish;
    wish.major = 2;
    wish.minor = 1;
    wish.surface = surfaceConfig(w.config, 1, 1);
    auto made = platform_->createContext(wish, nullptr);
    if (!made) {
        out_.log("depth of other tiles can't be put together here, copies of it across tiles are incomplete: " + made.error().message);
        return nullptr;
    }
    w.filler = std::move(*made);
    return w.filler.get();
}

void Replay::fillByOtherContext(const PixelViewport& r, GLbitfield plane, const void* pixels) {
    Window& w = *boundRead_;
    gl::Context* const filler = fillerOf(w);
    if (!filler || !platform_->makeCurrent(filler, w.surface.get(), w.surface.get())) return;
    const bool depth = plane == GL_DEPTH_BUFFER_BIT;
    if (gl.glDrawPixels && gl.glWindowPos2i) {
        gl.glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        depth ? gl.glEnable(GL_DEPTH_TEST) : gl.glDisable(GL_DEPTH_TEST);
        gl.glDepthFunc(GL_ALWAYS);
        gl.glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl.glWindowPos2i(r.x, r.y);
        gl.glDrawPixels(r.w, r.h, depth ? GL_DEPTH_COMPONENT : GL_STENCIL_INDEX, depth ? GL_UNSIGNED_INT : GL_UNSIGNED_BYTE, pixels);
        gl.glFlush();
    }
    (void)platform_->makeCurrent(c_->context.get(), boundDraw_ ? boundDraw_->surface.get() : nullptr, w.surface.get());
}

} // namespace mural
