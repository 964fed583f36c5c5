// Resync of a restarted node. It replays quickly what the other nodes took long to draw. It does not draw frames whose
// pictures are not needed: its region is empty, as in frames of another phase. Draw calls without other effects are
// skipped. When it has nearly caught up it draws again, each window from its next frame on.
//
// A window's buffers are stale until a full clear. Drawing over stale buffers, reading or showing them would differ
// from the other nodes. The code here detects that beforehand and ends the node; the next incarnation draws all frames.
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/window_use.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

// Returns false if another node depends on this node's picture, or if a copy of the window is filled from outside the
// stream. No node depends on the range of a node in resync.
bool Replay::maySkip() const {
    const RenderPass& p = config_.pass;
    return config_.skips && !config_.lean && (takesRanges() || !alone()) && !takesTurns() && !drawsOtherPixels() &&
           !movesView() && p.samples == 1;
}

void Replay::drawAgain() { skips_ = false; }

// Called before any command that may change pixels of the window.
void Replay::onSkipped(uint16_t opcode, std::span<const std::byte> arguments) {
    const WindowUse use = useOf(opcode);
    if (use == WindowUse::FeedbackBegins || use == WindowUse::FeedbackEnds)
        c_->feedsBack = use == WindowUse::FeedbackBegins;
    if ((use != WindowUse::Clears && use != WindowUse::Draws) || !drawsWindow() || !c_->draw || c_->compiling) return;
    Window& w = *c_->draw;
    if (!w.begun && w.skipped && !skips_) {
        w.skipped = false;
        placePart(w);
        restoreWindowState();
    }
    w.begun = true;
    if (w.skipped) {
        w.stale = kWindowBuffers | GL_ACCUM_BUFFER_BIT;
        w.frontStaled = true;
        return;
    }
    if (w.stale == 0) return;
    const GLbitfield clears = use == WindowUse::Clears ? clearsOf(opcode, arguments) : 0;
    const GLbitfield whole = clearedBy(opcode, arguments);
    w.stale &= ~whole;
    if (whole & GL_COLOR_BUFFER_BIT) w.invalid = false;
    const GLbitfield needed = use == WindowUse::Clears               ? clears & ~whole
                              : hasTrait(opcode, Trait::Accumulates) ? GLbitfield{GL_ACCUM_BUFFER_BIT}
                                                                     : needsCleared();
    if (needed & w.stale) w.invalid = true;
}

bool Replay::isValid(const Window& w, bool front) const {
    return !w.skipped && !w.invalid && !(w.stale & GL_COLOR_BUFFER_BIT) && !(front && w.frontStaled);
}

bool Replay::mayRead(const Window& w, bool deep) const {
    const bool front =
        c_->readBuffer0 == GL_FRONT || c_->readBuffer0 == GL_FRONT_LEFT || c_->readBuffer0 == GL_FRONT_RIGHT;
    const GLbitfield read = deep ? GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT : GL_COLOR_BUFFER_BIT;
    return !w.invalid && !(w.stale & read) && !(front && w.frontStaled);
}

wire::FrameValidity Replay::validity() const {
    if (showedInvalid_) return wire::FrameValidity::Invalid;
    for (const auto& [id, client] : clients_)
        for (const auto& [name, w] : client.windows)
            if (!isValid(*w, false)) return wire::FrameValidity::Open;
    return wire::FrameValidity::Valid;
}

} // namespace mural
