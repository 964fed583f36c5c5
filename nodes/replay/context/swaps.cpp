// Ends frames and reads the picture of the window.
//
// A thread may swap a window that is not current, even without any context (GLX 1.4, 3.3.10). The replay then binds the
// window for the read, with the context that drew there last: the driver orders the read after the draws of that
// context.
#include <utility>

#include "common/base/clock.hpp"
#include "nodes/player/pixel_mapping.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {

namespace {
constexpr int64_t kPatientFrames = 60; // longest wait for a full clear
} // namespace

// Waits for a fence where the driver has fences. For a framebuffer with one colour buffer, glFinish of Mesa copies the
// whole picture to a window that does not exist (measured: a quarter of this thread's time at 800x600).
void Replay::waitUntilDrawn() {
    constexpr GLuint64 kPatienceNs = 60'000'000'000;
    if (!bound_) return;
    const GLsync drawn = hasFences(*bound_) ? gl.glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0) : nullptr;
    const GLenum state = drawn ? gl.glClientWaitSync(drawn, GL_SYNC_FLUSH_COMMANDS_BIT, kPatienceNs) : GL_WAIT_FAILED;
    if (drawn) gl.glDeleteSync(drawn);
    const bool done = state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
    if (!done && gl.glFinish) gl.glFinish();
}

// Returns null if no context of the program was ever current.
Replay::ContextState* Replay::contextFor(const Client& client, const Window& w) const {
    if (w.drawer) return w.drawer;
    if (s_->context) return s_->context;
    for (const auto& [id, c] : client.contexts)
        if (c->everCurrent) return c.get();
    return nullptr;
}

// Returns whether this node reads or sends pixels of a window that is not bound.
bool Replay::mustBindForSwap(const Window& w, uint32_t frame, bool front) const {
    if (!w.surface || (bound_ && boundDraw_ == &w)) return false;
    return takesRanges() || (frame != wire::kUnseenFrame && !regionOf(w, front).empty());
}

bool Replay::onSwap(Args& in, bool front) {
    const auto id = in.get<uint32_t>(), frame = in.get<uint32_t>();
    if (!in.ok()) return false;
    Client& client = clients_[wire::clientOf(stream_)];
    const auto it = client.windows.find(id);
    Window* const window = it == client.windows.end() ? nullptr : it->second.get();
    ContextState* const drawer =
        window && mustBindForSwap(*window, frame, front) ? contextFor(client, *window) : nullptr;
    if (drawer)
        swapUnbound(*window, *drawer, id, frame, front);
    else
        showWindow(window, id, frame, front);
    sendPrefetched();
    return true;
}

// Binds the window, shows it, and binds the previous window again.
void Replay::swapUnbound(Window& w, ContextState& drawer, uint32_t id, uint32_t frame, bool front) {
    Stream before;
    before.context = bound_;
    before.draw = boundDraw_;
    before.read = boundRead_;
    Window* const draw = drawer.draw;
    Window* const read = drawer.read;
    // Mesa collects vertices before it draws them. Without a flush it would draw them into the next bound window.
    if (bound_ && gl.glFlush) gl.glFlush();
    Stream forSwap;
    forSwap.context = &drawer;
    forSwap.draw = forSwap.read = &w;
    (void)bindStream(forSwap);
    showWindow(&w, id, frame, front);
    drawer.draw = draw;
    drawer.read = read;
    if (before.context) (void)bindStream(before);
    (void)bindStream(*s_);
}

void Replay::showWindow(Window* window, uint32_t id, uint32_t frame, bool front) {
    PlayerOutputs::Frame f{};
    f.valid = true;
    f.client = wire::clientOf(stream_);
    f.window = id;
    f.frame = frame;
    f.drawnWhole = bound_ && bound_->shared && bound_->shared->allDrawn;
    ++counts_.frames;
    Window* readable = nullptr; // the window, if its pixels can be read
    if (window) {
        Window& w = *window;
        if (takesRanges()) rangeDrawn(w);
        f.notSplit = takesRanges() && !w.range.wasSplit;
        f.config = w.config;
        f.format = PictureFormat::Bgra8;
        const PixelViewport part = front ? partOf(w, areasOf(w, true)) : w.part;
        f.region = drawsOtherPixels() && !w.region.empty() ? inShown(config_.pass, part) : regionOf(w, front);
        f.picture = drawsOtherPixels() ? inShown(config_.pass, w.whole) : w.whole;
        f.keepsPicture = keepsTurn(w);
        f.areas = moves() ? w.moving.areas->number : 0;
        f.shares = w.range.drawnBy;
        f.keepsAreas = moves() && w.moving.areas != areas_ && ++w.moving.waits >= kPatientFrames;
        f.isUnzoomed = config_.movesZoom && w.plain;
        f.valid = isValid(w, front);
        if (!front && f.valid) w.frontStaled = false;
        showedInvalid_ = showedInvalid_ || (!f.valid && !w.skipped && w.begun);
        if (bound_ && &w == boundDraw_ && w.surface)
            readable = &w, f.format = pictureFormatOf(*bound_, w),
            f.pixels = [this, &w, front](const PixelViewport& r) {
                ContextState* const own = std::exchange(c_, bound_);
                const bool zoomed = (w.plain ? Zoom{} : passOf(w, front).zoom) != config_.pass.shown && !r.empty();
                const std::byte* pixels = zoomed                                 ? readScaled(w, r, front)
                                          : hasKernel() && w.plain && !r.empty() ? readEveryNth(w, r, front)
                                                                                 : readShown(w, r, front);
                c_ = own;
                return pixels;
            };
        // Without a context or a surface the picture is black. The frame still counts, and the log has the reason.
        else
            f.pixels = [black = std::vector<std::byte>()](const PixelViewport& r) mutable {
                black.assign(static_cast<size_t>(r.area()) * 4, std::byte{0});
                return static_cast<const std::byte*>(black.data());
            };
    }
    if (window && bound_) flushIfRequested(*window);
    // A frame ends after its draws, because pacing and frame rates depend on that. If its picture is read later, the
    // frame ends with that read.
    const bool shown = frame != wire::kUnseenFrame;
    const bool later = shown && readable && readsLater(*readable, f.region, front);
    const int64_t beganNs = monotonicNowNs();
    if (!skips_ && !later) waitUntilDrawn();
    reportDriverProblems();
    bool read = false;
    if (f.pixels)
        f.read = [&]() -> std::unique_ptr<PictureRead> {
            read = true;
            std::unique_ptr<PictureRead> picture = later ? readLater(*readable, f.region, front) : nullptr;
            if (!picture) picture = readAtOnce(f, f.region);
            if (readable && config_.readback == Readback::Auto) readable->readback.took(monotonicNowNs() - beganNs);
            return picture;
        };
    if (shown) out_.frameDone(f);
    if (later && !read) waitUntilDrawn();
    if (window) turnDrawn(*window, front);
    if (window && window->front && !front) showBack(*window);
}

} // namespace mural
