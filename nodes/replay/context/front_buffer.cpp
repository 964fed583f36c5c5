// Front and back of a window whose surface has a single colour buffer. A second surface holds the front buffer from the
// first command that names it. The program's window shares depth and stencil between both; here they are copied to the
// current draw surface. Draws to both buffers go to the back, which is then copied to the front.
#include <utility>

#include "common/log/log.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

bool isBoth(GLenum buffer) { return buffer == GL_FRONT_AND_BACK || buffer == GL_LEFT || buffer == GL_RIGHT; }
GLenum readFrom(GLenum buffer) { return isBoth(buffer) ? GL_FRONT : buffer; } // stands for several buffers
bool isFront(GLenum buffer) { return buffer == GL_FRONT || buffer == GL_FRONT_LEFT || buffer == GL_FRONT_RIGHT; }

constexpr GLbitfield kDeep = GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;

} // namespace

bool Replay::hasTwoSurfaces(const Window* w) const {
    return w && w->surface && w->config.doubleBuffer && w->surface->singleBuffered() && c_->api == wire::Api::Desktop &&
           gl.glBlitFramebuffer && platform_->readsOtherSurfaces();
}

// The surface of the window's buffer. Creates the front surface on demand; binding fills it.
gl::Surface* Replay::surfaceOf(Window* w, GLenum buffer) {
    if (!w) return nullptr;
    if (!isFront(buffer) || !hasTwoSurfaces(w) || (w == c_->draw && isBoth(c_->drawBuffer0))) return w->surface.get();
    if (!w->front) {
        auto made = platform_->createSurface(surfaceConfig(w->config, w->surface->width(), w->surface->height()));
        if (!made) {
            log::warning(
                log::Topic::Replay,
                "cannot create a second framebuffer for the front buffer of a window; it is shown with the back "
                "buffer: " +
                    made.error().message);
            return w->surface.get();
        }
        w->front = std::move(*made);
        w->frontStale = true;
        w->deep = w->surface.get();
    }
    return w->front.get();
}

// Makes bound_, boundDraw_ and boundRead_ current.
bool Replay::bindSurfaces(gl::PendingCommands pendingCommands) {
    const auto bind = [&] {
        drawSurface_ = surfaceOf(boundDraw_, c_->drawBuffer0);
        readSurface_ = surfaceOf(boundRead_, readFrom(c_->readBuffer0));
        return platform_->makeCurrent(bound_->context.get(), drawSurface_, readSurface_, pendingCommands);
    };
    auto made = bind();
    if (made && !loaded_) { // before the first load, surface support is unknown
        loadFunctions();
        made = bind();
    }
    if (!made) {
        log::warning(log::Topic::Replay, "cannot make a context current: " + made.error().message);
        unbindPlatform(); // the current surfaces are undefined after a failure
        return false;
    }
    for (Window* w : {boundDraw_, boundRead_}) {
        if (w && w->front && w->frontStale && (drawSurface_ == w->front.get() || readSurface_ == w->front.get()))
            beginFront(*w);
    }
    if (boundDraw_ && boundDraw_->front && boundDraw_->deep != drawSurface_) {
        copySurface(*boundDraw_->deep, *drawSurface_, kDeep);
        boundDraw_->deep = drawSurface_;
    }
    return true;
}

// Called after the program has chosen other buffers of its windows.
void Replay::buffersChanged(GLenum drawnBefore) {
    if (!bound_ || c_ != bound_) return;
    // The front has the picture that was drawn to both, also if no command has named it yet.
    if (boundDraw_ && isBoth(drawnBefore) && !isBoth(c_->drawBuffer0) && hasTwoSurfaces(boundDraw_) &&
        surfaceOf(boundDraw_, GL_FRONT) == boundDraw_->front.get())
        backToFront(*boundDraw_);
    if (surfaceOf(boundDraw_, c_->drawBuffer0) != drawSurface_ ||
        surfaceOf(boundRead_, readFrom(c_->readBuffer0)) != readSurface_)
        (void)bindSurfaces();
}

// Fills a new or stale front buffer.
void Replay::beginFront(Window& w) {
    if (w.config.doubleBuffer != wire::kOwnFront) return backToFront(w);
    w.frontStale = false;
    w.moving.front = w.moving.areas;
    if (platform_->makeCurrent(bound_->context.get(), w.front.get(), w.front.get()))
        withQueriesSuspended([&] { clearToBlack(*w.front); });
    (void)platform_->makeCurrent(bound_->context.get(), drawSurface_, readSurface_);
    c_->scissorsDiffer = true; // all viewports' enables were touched
    applyScissors();
}

// Clears colours and alpha of the current surface. Keeps all program state except the scissors: the caller applies them
// again.
void Replay::clearToBlack(gl::Surface& current) {
    GLfloat colour[4] = {};
    GLboolean mask[4] = {};
    gl.glGetFloatv(GL_COLOR_CLEAR_VALUE, colour);
    gl.glGetBooleanv(GL_COLOR_WRITEMASK, mask);
    const auto setMask = [&](GLboolean r, GLboolean g, GLboolean b, GLboolean a) {
        gl.glColorMaski ? gl.glColorMaski(0, r, g, b, a) : gl.glColorMask(r, g, b, a);
    };
    const GLboolean discards = c_->version >= 30 && gl.glIsEnabled(GL_RASTERIZER_DISCARD);
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    gl.glDrawBuffer(onlyBuffer(current));
    gl.glDisable(GL_SCISSOR_TEST);
    if (discards) gl.glDisable(GL_RASTERIZER_DISCARD);
    setMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.glClearColor(0, 0, 0, 0);
    gl.glClear(GL_COLOR_BUFFER_BIT);
    gl.glClearColor(colour[0], colour[1], colour[2], colour[3]);
    setMask(mask[0], mask[1], mask[2], mask[3]);
    if (discards) gl.glEnable(GL_RASTERIZER_DISCARD);
    gl.glDrawBuffer(windowBuffer(c_->drawBuffer0, boundDraw_));
    gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(Kind::Framebuffer, c_->drawFramebuffer));
}

void Replay::backToFront(Window& w) {
    w.frontStale = false;
    w.moving.front = w.moving.areas;
    copySurface(*w.surface, *w.front, GL_COLOR_BUFFER_BIT);
}

// After a swap the front has the back's content. Deferred if another window is current.
void Replay::showBack(Window& w) {
    if (w.config.doubleBuffer == wire::kOwnFront) return;
    w.frontStale = true;
    if (!bound_ || (drawSurface_ != w.front.get() && readSurface_ != w.front.get() && boundDraw_ != &w)) return;
    ContextState* const own = std::exchange(c_, bound_);
    backToFront(w);
    c_ = own;
}

// Copies the window's depth and stencil to the surface that the program reads from.
void Replay::depthForReading() {
    if (!bound_ || !boundRead_ || !boundRead_->front || readSurface_ == boundRead_->deep) return;
    copySurface(*boundRead_->deep, *readSurface_, kDeep);
}

// Copies the whole surface, independently of the program's state.
void Replay::copySurface(gl::Surface& from, gl::Surface& to, GLbitfield planes) {
    if (platform_->makeCurrent(bound_->context.get(), &to, &from)) {
        gl.glBindFramebuffer(GL_FRAMEBUFFER, 0);
        gl.glReadBuffer(onlyBuffer(from));
        gl.glDrawBuffer(onlyBuffer(to));
        gl.glDisable(GL_SCISSOR_TEST);
        const bool srgb = gl.glIsEnabled(GL_FRAMEBUFFER_SRGB);
        if (srgb) gl.glDisable(GL_FRAMEBUFFER_SRGB);
        gl.glBlitFramebuffer(0, 0, from.width(), from.height(), 0, 0, to.width(), to.height(), planes, GL_NEAREST);
        if (srgb) gl.glEnable(GL_FRAMEBUFFER_SRGB);
        gl.glReadBuffer(windowBuffer(c_->readBuffer0, boundRead_));
        gl.glDrawBuffer(windowBuffer(c_->drawBuffer0, boundDraw_));
        gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, name(Kind::Framebuffer, c_->readFramebuffer));
        gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(Kind::Framebuffer, c_->drawFramebuffer));
    }
    (void)platform_->makeCurrent(bound_->context.get(), drawSurface_, readSurface_);
    c_->scissorsDiffer = true; // the enables of all viewports have changed
    applyScissors();
}

// True if draws go to a front buffer that is divided differently from the back; every node then draws all of it.
bool Replay::drawsOldFront() const {
    const Window* const w = c_->draw;
    return moves() && w && w->front && w->moving.front != w->moving.areas && isFront(c_->drawBuffer0);
}

bool Replay::readsFront() const { return isFront(readFrom(c_->readBuffer0)); }

// This node's region of the window's back or front buffer.
PixelViewport Replay::regionOf(const Window& w, bool front) const {
    if (!moves() || !front || !w.front || w.skipped) return w.region;
    return partDrawn(w, true);
}

// Called when the window receives another surface.
void Replay::dropFront(Window& w) {
    w.front.reset();
    w.deep = nullptr;
}

} // namespace mural
