// A node that comes back replays in a moment what the others took long for. Frames that nobody waits for are not drawn
// then: its region of windows is empty, as in frames that are another node's turn, and draw calls that could change nothing
// else are left out. When it has nearly caught up it draws again, each window from its next frame on.
//
// What a window's buffers hold then is stale until they are cleared whole. Who draws over stale buffers, reads them or shows
// them would show another picture than the others: that is found here before anybody sees it, and the node, which can't mend
// it, ends; it is started again and draws all.
#include "gl_opcodes.hpp"
#include "nodes/replay/replay.hpp"
#include "nodes/replay/window_use.hpp"

namespace mural {

// Whose picture another node depends on, and where a copy of the window is not filled by the stream, all is drawn. Nobody depends on the
// range of a node that catches up.
bool Replay::maySkip() const {
    const RenderPass& p = config_.pass;
    return config_.skips && !config_.lean && (takesRanges() || !alone()) && !takesTurns() && !drawsOtherPixels() && !movesView() && p.samples == 1;
}

void Replay::drawAgain() { skips_ = false; }

// Before any command that may change pixels of the window.
void Replay::noteSkipped(uint16_t opcode, std::span<const std::byte> arguments) {
    const WindowUse use = useOf(opcode);
    if (use == WindowUse::FeedbackBegins || use == WindowUse::FeedbackEnds) c_->feedsBack = use == WindowUse::FeedbackBegins;
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
    if (whole & GL_COLOR_BUFFER_BIT) w.unsound = false;
    const GLbitfield needed = use == WindowUse::Clears ? clears & ~whole : opcode == op::glAccum ? GLbitfield{GL_ACCUM_BUFFER_BIT} : needsCleared();
    if (needed & w.stale) w.unsound = true;
}

bool Replay::isSound(const Window& w, bool front) const { return !w.skipped && !w.unsound && !(w.stale & GL_COLOR_BUFFER_BIT) && !(front && w.frontStaled); }

bool Replay::mayRead(const Window& w, bool deep) const {
    const bool front = c_->readBuffer0 == GL_FRONT || c_->readBuffer0 == GL_FRONT_LEFT || c_->readBuffer0 == GL_FRONT_RIGHT;
    const GLbitfield read = deep ? GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT : GL_COLOR_BUFFER_BIT;
    return !w.unsound && !(w.stale & read) && !(front && w.frontStaled);
}

wire::Soundness Replay::soundness() const {
    if (showedUnsound_) return wire::Soundness::Unsound;
    for (const auto& [id, client] : clients_)
        for (const auto& [name, w] : client.windows)
            if (!isSound(*w, false)) return wire::Soundness::Open;
    return wire::Soundness::Sound;
}

} // namespace mural
