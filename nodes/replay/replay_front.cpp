// Front and back of a window where a surface has one colour buffer: a second surface holds the front, from the first
// command on that names it. Depth and stencil are one for both in the program's window; here they go along to the
// surface that is drawn to. What is drawn into both at once goes to the back, and to the front when that ends.
#include <utility>

#include "nodes/replay/replay.hpp"

namespace mural {

namespace {

bool isBoth(GLenum buffer) { return buffer == GL_FRONT_AND_BACK || buffer == GL_LEFT || buffer == GL_RIGHT; }
GLenum readFrom(GLenum buffer) { return isBoth(buffer) ? GL_FRONT : buffer; } // one of several
bool isFront(GLenum buffer) { return buffer == GL_FRONT || buffer == GL_FRONT_LEFT || buffer == GL_FRONT_RIGHT; }

constexpr GLbitfield kDeep = GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;

} // namespace

bool Replay::hasTwoSurfaces(const Window* w) const {
    return w && w->surface && w->config.doubleBuffer && w->surface->singleBuffered() && c_->api == wire::Api::Desktop && gl.glBlitFramebuffer && platform_->readsOtherSurfaces();
}

// Which surface stands for the window's buffer. The front's is made here, and filled when it is bound.
gl::Surface* Replay::surfaceOf(Window* w, GLenum buffer) {
    if (!w) return nullptr;
    if (!isFront(buffer) || !hasTwoSurfaces(w) || (w == c_->draw && isBoth(c_->drawBuffer0))) return w->surface.get();
    if (!w->front) {
        auto made = platform_->createSurface(surfaceConfig(w->config, w->surface->width(), w->surface->height()));
        if (!made) {
            out_.log("no second framebuffer for the front of a window can be made, it shows with the back: " + made.error().message);
            return w->surface.get();
        }
        w->front = std::move(*made);
        w->frontStale = true;
        w->deep = w->surface.get();
    }
    return w->front.get();
}

// Makes current what bound_, boundDraw_ and boundRead_ say.
bool Replay::bindSurfaces(gl::HeldBack heldBack) {
    const auto bind = [&] {
        drawSurface_ = surfaceOf(boundDraw_, c_->drawBuffer0);
        readSurface_ = surfaceOf(boundRead_, readFrom(c_->readBuffer0));
        return platform_->makeCurrent(bound_->context.get(), drawSurface_, readSurface_, heldBack);
    };
    auto made = bind();
    if (made && !loaded_) { // before that, nothing tells whether the front can have its own
        loadFunctions();
        made = bind();
    }
    if (!made) {
        out_.log("a context can't be made current: " + made.error().message);
        unbindPlatform(); // what is current after that, no driver tells
        return false;
    }
    for (Window* w : {boundDraw_, boundRead_}) {
        if (w && w->front && w->frontStale && (drawSurface_ == w->front.get() || readSurface_ == w->front.get())) backToFront(*w);
    }
    if (boundDraw_ && boundDraw_->front && boundDraw_->deep != drawSurface_) {
        copySurface(*boundDraw_->deep, *drawSurface_, kDeep);
        boundDraw_->deep = drawSurface_;
    }
    return true;
}

// The program has chosen other buffers of its windows.
void Replay::buffersChanged(GLenum drawnBefore) {
    if (!bound_ || c_ != bound_) return;
    if (boundDraw_ && boundDraw_->front && isBoth(drawnBefore) && !isBoth(c_->drawBuffer0)) backToFront(*boundDraw_);
    if (surfaceOf(boundDraw_, c_->drawBuffer0) != drawSurface_ || surfaceOf(boundRead_, readFrom(c_->readBuffer0)) != readSurface_) (void)bindSurfaces();
}

void Replay::backToFront(Window& w) {
    w.frontStale = false;
    w.moving.front = w.moving.areas;
    copySurface(*w.surface, *w.front, GL_COLOR_BUFFER_BIT);
}

// A swap: what was in the back is in the front now. Later, where another context than the window's is current.
void Replay::showBack(Window& w) {
    w.frontStale = true;
    if (!bound_ || (drawSurface_ != w.front.get() && readSurface_ != w.front.get() && boundDraw_ != &w)) return;
    ContextState* const own = std::exchange(c_, bound_);
    backToFront(w);
    c_ = own;
}

// Depth and stencil of the window, put where the program reads from.
void Replay::depthForReading() {
    if (!bound_ || !boundRead_ || !boundRead_->front || readSurface_ == boundRead_->deep) return;
    copySurface(*boundRead_->deep, *readSurface_, kDeep);
}

// All of it, whatever the program has set.
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
    c_->scissorsDiffer = true; // all viewports' enables were touched
    applyScissors();
}

// What is drawn to now is a front that is divided in another way than the back: every node draws all of it.
bool Replay::drawsOldFront() const {
    const Window* const w = c_->draw;
    return moves() && w && w->front && w->moving.front != w->moving.areas && isFront(c_->drawBuffer0);
}

bool Replay::readsFront() const { return isFront(readFrom(c_->readBuffer0)); }

// What this node has of the window's picture, or of its front.
PixelViewport Replay::regionOf(const Window& w, bool front) const {
    if (!moves() || !front || !w.front || w.skipped) return w.region;
    return partOf(w, w.moving.front.get());
}

// Of a window that gets another surface.
void Replay::dropFront(Window& w) {
    w.front.reset();
    w.deep = nullptr;
}

} // namespace mural
