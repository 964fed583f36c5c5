// Time-multiplex: this node draws the frames whose turn is its own, and of all others nothing in windows. Its region is
// empty then, so that scissors, answers, counts and pictures need no rule of their own. Framebuffer objects are drawn by
// all: their contents outlive frames.
//
// Only frames that clear their window before they draw there can be drawn by a node that has not drawn the one
// before. Whether a program does that is seen by every node alike: the first frames are drawn by all, and from the
// first one on that builds on what was there, all frames of that window are.
// Source: thesis, "Time-Multiplex (DPlex)".
#include <cstring>
#include <string_view>
#include <utility>

#include "gl_opcodes.hpp"
#include "nodes/replay/replay.hpp"
#include "streamcodec/opcode_names.hpp"

namespace mural {

namespace {

constexpr int64_t kLearnedFrames = 2;

enum class WindowUse : uint8_t { None, Clears, Draws };

bool draws(std::string_view name) {
    if (name.starts_with("glDrawBuffer")) return false;
    for (const std::string_view stem : {"glDraw", "glMultiDraw", "glMultiMode", "glBegin", "glCallList", "glRect", "glEvalMesh", "glBitmap", "glCopyPixels", "glBlit", "glAccum", "glClear"}) {
        if (!name.starts_with(stem)) continue;
        // State, not drawing: glClearColor, glBeginQuery, …
        if (stem == "glBegin") return name == "glBegin";
        if (stem == "glClear") return name == "glClear" || name.starts_with("glClearBuffer") || name.starts_with("glClearNamedFramebuffer");
        return true;
    }
    return false;
}

WindowUse useOf(uint16_t opcode) {
    static const auto kUses = [] {
        std::vector<WindowUse> uses(op::kLimit, WindowUse::None);
        for (uint16_t o = wire::kFirstGlOpcode; o < op::kLimit; ++o) {
            const char* name = glOpcodeName(o);
            if (name && draws(name)) uses[o] = o == op::glClear ? WindowUse::Clears : WindowUse::Draws;
        }
        return uses;
    }();
    return kUses[opcode];
}

} // namespace

bool Replay::learnsTurns(const Window& w) const { return takesTurns() && w.turn < kLearnedFrames; }

// After its size or the turn has changed.
void Replay::placePart(Window& w) {
    const bool mine = !takesTurns() || w.turn % config_.pass.period == config_.pass.phase;
    w.region = !mine ? PixelViewport{} : interleaves(&w) ? inKernel(w.part) : w.part;
    w.drawn = w.range.muted ? PixelViewport{} : w.region;
    if (takesRanges() && !collects()) w.region = {}; // the collector's
    if (w.config.samples == 0 || w.region.empty() || w.drawn.empty()) return;
    // A driver may treat multisampled lines at scissor edges off its own raster of 64 pixels (accuracy, M4).
    const int32_t x0 = w.region.x / 64 * 64, y0 = w.region.y / 64 * 64;
    w.drawn = intersect({x0, y0, (w.region.right() + 63) / 64 * 64 - x0, (w.region.top() + 63) / 64 * 64 - y0}, w.whole);
}

// Which of the buffers a glClear with this mask gives one value everywhere.
GLbitfield Replay::clearsWhole(GLbitfield mask) const {
    GLbitfield cleared = mask & GL_STENCIL_BUFFER_BIT;
    if (c_->scissors[0].enabled) return 0;
    const auto& colours = c_->colorMasks.buffers[0];
    if (colours[0] && colours[1] && colours[2]) cleared |= mask & GL_COLOR_BUFFER_BIT;
    GLboolean depth = GL_TRUE;
    if (mask & GL_DEPTH_BUFFER_BIT) gl.glGetBooleanv(GL_DEPTH_WRITEMASK, &depth);
    return depth ? cleared | (mask & GL_DEPTH_BUFFER_BIT) : cleared;
}

// What a draw, as the state is now, would find there of an earlier frame.
GLbitfield Replay::needsCleared() const {
    const wire::WindowConfig& w = c_->draw->config;
    GLbitfield needed = GL_COLOR_BUFFER_BIT;
    if (w.depth > 0 && gl.glIsEnabled(GL_DEPTH_TEST)) needed |= GL_DEPTH_BUFFER_BIT;
    if (w.stencil > 0 && gl.glIsEnabled(GL_STENCIL_TEST)) needed |= GL_STENCIL_BUFFER_BIT;
    return needed;
}

// Before any command that may change pixels of the window.
void Replay::noteTurn(uint16_t opcode, std::span<const std::byte> arguments) {
    const WindowUse use = useOf(opcode);
    if (use == WindowUse::None || !drawsWindow() || !c_->draw || c_->compiling) return;
    Window& w = *c_->draw;
    if (w.turnOver) beginTurn(w);
    constexpr GLbitfield kAll = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    if (w.keepsPicture || w.cleared == kAll) return;
    if (use == WindowUse::Clears && arguments.size() >= 4) {
        GLbitfield mask = 0;
        std::memcpy(&mask, arguments.data(), 4);
        w.cleared |= clearsWhole(mask);
        if (!(mask & ~kAll)) return;
    }
    // Accumulation buffers are there to add up frames.
    const bool accumulates = opcode == op::glAccum || use == WindowUse::Clears;
    if (!accumulates && (needsCleared() & ~w.cleared) == 0) return;
    w.keepsPicture = true;
    restoreWindowState();
}

// The window's part is last frame's until somebody draws: what is read before that is last frame's, too.
void Replay::beginTurn(Window& w) {
    w.turnOver = false;
    w.cleared = 0;
    ++w.turn;
    placePart(w);
    restoreWindowState();
}

void Replay::turnDrawn(Window& w, bool shownInFront) {
    if (hasKernel()) {
        const bool plain = std::exchange(w.plain, std::exchange(w.copied, false));
        if (plain != w.plain) {
            placePart(w);
            if (&w == boundDraw_) {
                ContextState* const own = std::exchange(c_, bound_);
                restoreWindowState();
                c_ = own;
            }
        }
    }
    if (!takesTurns()) return;
    w.turnOver = true;
    w.keepsPicture = w.keepsPicture || shownInFront; // it is drawn into while it is seen
}

} // namespace mural
