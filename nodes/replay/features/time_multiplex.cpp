// Time-multiplex: this node draws the frames of its turns. In all other frames it draws nothing into windows. Its
// region is empty then, so scissors, replies, counts and pictures need no special cases. All nodes draw framebuffer
// objects, whose contents outlive frames.
//
// A frame that clears its window before it draws there begins the next node's turn. A frame that builds on the previous
// picture stays with the node that has that picture. The first command that is not a clear decides between the two; all
// nodes execute the clears. Every node receives the same commands, and so takes the same decision.
//
// Accumulation and front buffers keep the content of earlier frames, regardless of clears. From their first use, one
// node draws the window permanently. The same applies if a frame needs an older depth or stencil buffer after its
// decision. All nodes draw the first frames, so that such programs are detected before that matters.
// Source: thesis, "Time-Multiplex (DPlex)".
#include <cstring>
#include <utility>

#include "nodes/player/pixel_mapping.hpp"
#include "nodes/player/raster_bins.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/window_use.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

namespace {

constexpr int64_t kLearnedFrames = 2;
constexpr int64_t kDependentFrames = 8; // consecutive frames, after which the node reports that turns do not help

} // namespace

// Returns the window's buffers that a clear command addresses.
GLbitfield Replay::clearsOf(uint16_t opcode, std::span<const std::byte> arguments) const {
    GLuint words[2] = {};
    std::memcpy(words, arguments.data(), std::min(arguments.size(), sizeof words));
    if (hasTrait(opcode, Trait::Clear)) return words[0];
    switch (words[0]) { // glClearBuffer…
    case GL_COLOR: return GL_COLOR_BUFFER_BIT;
    case GL_DEPTH: return GL_DEPTH_BUFFER_BIT;
    case GL_STENCIL: return GL_STENCIL_BUFFER_BIT;
    case GL_DEPTH_STENCIL: return GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    default: return 0;
    }
}

bool Replay::isLearningTurns(const Window& w) const {
    return takesTurns() && (w.frames < kLearnedFrames || !knowsTurns_);
}

bool Replay::hasTurn(int64_t turn) const {
    return !takesTurns() || (knowsTurns_ && turn % config_.pass.period == config_.pass.phase);
}

// Recomputes the window's regions. Called after a change of its size or turn.
void Replay::placePart(Window& w) {
    if (w.skipped) {
        w.region = w.drawn = {};
        return;
    }
    const PixelViewport part = partDrawn(w);
    w.region = hasTurn(w.turn) ? part : PixelViewport{};
    w.drawn = copiesOthers() && w.drawsAll && !w.lean && hasTurn(w.turn) ? w.whole : w.region;
    if (w.range.muted) w.drawn = {};
    if (takesRanges() && !collects()) w.region = {}; // the collector has it
    if (!drawsWholeBins(w) || w.drawn.empty()) return;
    w.drawn =
        intersect(widenToBins(w.drawn, surfaceOf(w, false)), interleaves(&w) ? inPass(passOf(w), w.whole) : w.whole);
}

// Returns whether pixels of the window may depend on the position of scissor edges inside a bin of the driver.
bool Replay::drawsWholeBins(const Window& w) const {
    if (config_.plant == "edges") return false;
    return w.config.samples > 0 || (config_.rastersInBins && w.isFlat);
}

// Returns the buffers of `mask` that a clear, in the current state, sets to one value everywhere.
GLbitfield Replay::clearsWhole(GLbitfield mask) const {
    const bool discards = c_->version >= 30 && gl.glIsEnabled(GL_RASTERIZER_DISCARD);
    if (c_->scissors[0].enabled || c_->conditional || discards) return 0;
    const wire::WindowConfig& w = c_->draw->config;
    const auto& colours = c_->colorMasks.buffers[0];
    const bool front = w.doubleBuffer && (c_->drawBuffer0 == GL_FRONT || c_->drawBuffer0 == GL_FRONT_LEFT ||
                                          c_->drawBuffer0 == GL_FRONT_RIGHT || c_->drawBuffer0 == GL_NONE);
    GLbitfield cleared = 0;
    if (colours[0] && colours[1] && colours[2] && (colours[3] || w.alpha == 0) && !front)
        cleared |= mask & GL_COLOR_BUFFER_BIT;
    GLboolean depth = GL_TRUE;
    GLint stencil = 255;
    if (mask & GL_DEPTH_BUFFER_BIT) gl.glGetBooleanv(GL_DEPTH_WRITEMASK, &depth);
    if (mask & GL_STENCIL_BUFFER_BIT) gl.glGetIntegerv(GL_STENCIL_WRITEMASK, &stencil);
    if (depth) cleared |= mask & GL_DEPTH_BUFFER_BIT;
    if ((stencil & 255) == 255) cleared |= mask & GL_STENCIL_BUFFER_BIT;
    return cleared;
}

// Returns the buffers whose earlier content a draw, in the current state, would use.
GLbitfield Replay::needsCleared() const {
    const wire::WindowConfig& w = c_->draw->config;
    GLbitfield needed = GL_COLOR_BUFFER_BIT;
    if (w.depth > 0 && gl.glIsEnabled(GL_DEPTH_TEST)) needed |= GL_DEPTH_BUFFER_BIT;
    if (w.stencil > 0 && gl.glIsEnabled(GL_STENCIL_TEST)) needed |= GL_STENCIL_BUFFER_BIT;
    return needed;
}

// Called before any command that may change pixels of the window.
void Replay::onTurn(uint16_t opcode, std::span<const std::byte> arguments) {
    const WindowUse use = useOf(opcode);
    if (use == WindowUse::FeedbackBegins || use == WindowUse::FeedbackEnds)
        c_->feedsBack = use == WindowUse::FeedbackBegins;
    if ((use != WindowUse::Clears && use != WindowUse::Draws) || !drawsWindow() || !c_->draw || c_->compiling) return;
    Window& w = *c_->draw;
    if (w.turnOver) beginTurn(w);
    if (w.keepsPicture) return;
    const GLbitfield clears = use == WindowUse::Clears ? clearsOf(opcode, arguments) : 0;
    if (hasTrait(opcode, Trait::Accumulates) || (clears & GL_ACCUM_BUFFER_BIT)) return keepTurn(w);
    const GLbitfield whole = clearedBy(opcode, arguments);
    w.cleared |= whole;
    if (use == WindowUse::Clears && (clears & kWindowBuffers & ~whole) == 0) return;
    const bool builds = ((use == WindowUse::Clears ? clears & kWindowBuffers : needsCleared()) & ~w.cleared) != 0;
    if (w.undecided) return decideTurn(w, builds);
    if (builds && w.fresh) keepTurn(w); // detected too late for this frame
}

// The list is compiled and executed at once: the driver draws its commands immediately, with state that the list may
// change. The turn must therefore be decided before. Only buffers that were cleared are equal on all nodes.
void Replay::onTurnOfList() {
    if (!takesTurns() || c_->compileMode != GL_COMPILE_AND_EXECUTE || !drawsWindow() || !c_->draw) return;
    Window& w = *c_->draw;
    if (w.turnOver) beginTurn(w);
    if (w.keepsPicture) return;
    const GLbitfield needed = GLbitfield{GL_COLOR_BUFFER_BIT} | (w.config.depth > 0 ? GL_DEPTH_BUFFER_BIT : 0) |
                              (w.config.stencil > 0 ? GL_STENCIL_BUFFER_BIT : 0);
    const bool builds = (needed & ~w.cleared) != 0;
    if (w.undecided) return decideTurn(w, builds);
    if (builds && w.fresh) keepTurn(w);
}

// Called at the first command that draws. Until then the window's part belongs to the previous frame, and so do reads.
void Replay::beginTurn(Window& w) {
    w.turnOver = false;
    w.cleared = 0;
    w.fresh = false;
    ++w.frames;
    w.undecided = !w.keepsPicture;
    restoreWindowState(); // the frames that all nodes draw may have ended
}

void Replay::decideTurn(Window& w, bool builds) {
    w.undecided = false;
    w.fresh = !builds;
    w.dependentFrames = builds ? w.dependentFrames + 1 : 0;
    if (w.fresh) ++w.turn;
    placePart(w);
    restoreWindowState();
}

// Gives the turn permanently to the node that has it.
void Replay::keepTurn(Window& w) {
    w.keepsPicture = true;
    if (w.undecided) decideTurn(w, true);
}

bool Replay::keepsTurn(const Window& w) const { return w.keepsPicture || w.dependentFrames >= kDependentFrames; }

void Replay::partChanged(Window& w) {
    placePart(w);
    if (&w != boundDraw_) return;
    ContextState* const own = std::exchange(c_, bound_);
    restoreWindowState();
    c_ = own;
}

void Replay::turnDrawn(Window& w, bool shownInFront) {
    w.sceneWasElsewhere = std::exchange(w.sceneElsewhere, false);
    if (tracksCopies()) {
        // windows that keep their areas would keep their zoom; modules that read gl_FragCoord, or counted fragments
        const bool needsAll = bound_ && bound_->shared && bound_->shared->allDrawn;
        const bool keepsZoom = config_.anyMovesZoom && w.moving.fixed;
        const bool plain = std::exchange(w.plain, std::exchange(w.copied, false) || needsAll || keepsZoom);
        w.levelChecks = 0;
        if (plain != w.plain) partChanged(w);
    }
    if (copiesOthers() && std::exchange(w.drawsAll, std::exchange(w.filled, false)) != w.drawsAll) partChanged(w);
    w.begun = false;
    if (!takesTurns()) return;
    w.turnOver = true;
    w.keepsPicture = w.keepsPicture || shownInFront; // the program draws into a visible buffer
}

// ---- returned nodes: their snapshot leaves out frames, so they cannot count

std::vector<wire::WindowTurn> Replay::turns() const {
    std::vector<wire::WindowTurn> turns;
    for (const auto& [client, its] : clients_)
        for (const auto& [id, w] : its.windows) {
            const uint32_t state = (w->turnOver ? wire::kTurnOver : 0) | (w->undecided ? wire::kTurnUndecided : 0) |
                                   (w->fresh ? wire::kTurnFresh : 0) | (w->keepsPicture ? wire::kTurnForGood : 0);
            turns.push_back({client, id, w->frames, w->turn, w->dependentFrames, w->cleared, state});
        }
    return turns;
}

void Replay::takeTurns(std::span<const wire::WindowTurn> turns) {
    for (const wire::WindowTurn& t : turns) {
        const auto client = clients_.find(t.client);
        if (client == clients_.end()) continue;
        const auto found = client->second.windows.find(t.window);
        if (found == client->second.windows.end()) continue;
        Window& w = *found->second;
        w.frames = t.frames;
        w.turn = t.turn;
        w.dependentFrames = t.dependentFrames;
        w.cleared = t.cleared;
        w.turnOver = (t.state & wire::kTurnOver) != 0;
        w.undecided = (t.state & wire::kTurnUndecided) != 0;
        w.fresh = (t.state & wire::kTurnFresh) != 0;
        w.keepsPicture = (t.state & wire::kTurnForGood) != 0;
    }
    turnsChanged();
}

void Replay::beginTurns() {
    if (!takesTurns()) return;
    for (auto& [client, its] : clients_)
        for (auto& [id, w] : its.windows) {
            w->turn = w->dependentFrames = 0;
            w->undecided = w->fresh = w->keepsPicture = false;
        }
    turnsChanged();
}

void Replay::turnsChanged() {
    knowsTurns_ = true;
    for (auto& [client, its] : clients_)
        for (auto& [id, w] : its.windows) placePart(*w);
    if (!bound_) return;
    ContextState* const own = std::exchange(c_, bound_);
    restoreWindowState();
    c_ = own;
}

} // namespace mural
