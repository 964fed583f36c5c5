#include "nodes/head/session/slowdown_advice.hpp"

#include "streamcodec/wire/node_messages.hpp"

namespace mural {

void SlowdownAdvice::frameDone(uint32_t flags, bool sharesDraws) {
    if (flags & wire::kDrawnWhole && !drawnWhole_.exchange(true))
        control_.say(tiling_ == Tiling::Lean
                         ? "fragment shaders write to memory, SPIR-V modules read gl_FragCoord, display lists read the "
                           "picture, or samples of it are copied: every node draws all of it, into framebuffers of the "
                           "window's size; tiling lean saves nothing there"
                         : "fragment shaders write to memory, display lists read the picture, or samples of it are "
                           "copied: every node draws all of it; more nodes do not make that faster");
    if (flags & wire::kKeepsAreas && !keepsAreas_.exchange(true))
        control_.say("frames of a window are drawn without a clear of all that its buffers hold (or into its front, or "
                     "accumulated): its tiles stay with the nodes that have them; a queue does not make that faster");
    if (flags & wire::kKeepsPicture && !keepsPicture_.exchange(true))
        control_.say("frames are drawn over the picture before them (no clear, accumulation, or the front buffer): one "
                     "node goes on drawing them; --dplex does not make that faster");
    if (sharesDraws) countUnshared(flags);
}

// The first frames decide: one shared frame among them silences the advice for good.
void SlowdownAdvice::countUnshared(uint32_t flags) {
    constexpr int64_t kFrames = 100;
    if (!(flags & wire::kNotSplit))
        unsharedFrames_ = INT64_MIN / 2;
    else if (++unsharedFrames_ == kFrames * nodeCount_)
        control_.say(
            "none of the program's first frames has draws that nodes can share (opaque, with a depth test, into its "
            "window, behind a clear of colour and depth): one node draws all; --db does not make that faster");
}

} // namespace mural
