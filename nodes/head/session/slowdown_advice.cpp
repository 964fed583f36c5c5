#include "nodes/head/session/slowdown_advice.hpp"

#include "common/log/log.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {
namespace {

constexpr DivisionLimit kLeanDrawnWhole = {
    "drawn-whole", "every node draws the whole picture, into framebuffers of the window's size, because fragment "
                   "shaders write to memory, SPIR-V modules read gl_FragCoord, display lists read the picture, or its "
                   "samples are copied; --tiling lean saves nothing for this program"};
constexpr DivisionLimit kDrawnWhole = {
    "drawn-whole", "every node draws the whole picture, because fragment shaders write to memory, display lists read "
                   "the picture, or its samples are copied; more nodes do not make this program faster"};
constexpr DivisionLimit kAreasStay = {
    "areas-stay",
    "tiles of a window stay with their nodes, because frames do not clear all of its buffers, draw "
    "into its front buffer, or accumulate; a tile queue or DFR_equalizer does not make this program faster"};
constexpr DivisionLimit kFramesBuildUp = {
    "frames-build-up", "one node draws all frames, because they build on the previous picture (no clear, accumulation, "
                       "or front buffer); --dplex does not make this program faster"};
constexpr DivisionLimit kDrawsUnshared = {
    "draws-unshared",
    "one node draws everything, because the first frames have no draws that nodes can share (opaque, with "
    "depth test, into the window, after a clear of colour and depth); --db does not make this program faster"};

} // namespace

void SlowdownAdvice::frameDone(uint32_t flags, bool sharesDraws) {
    if (flags & wire::kDrawnWhole && !drawnWhole_.exchange(true))
        advise(tiling_ == Tiling::Lean ? kLeanDrawnWhole : kDrawnWhole);
    if (flags & wire::kKeepsAreas && !keepsAreas_.exchange(true)) advise(kAreasStay);
    if (flags & wire::kKeepsPicture && !keepsPicture_.exchange(true)) advise(kFramesBuildUp);
    if (sharesDraws) countUnshared(flags);
}

std::vector<DivisionLimit> SlowdownAdvice::limits() const {
    const std::lock_guard lock(mutex_);
    return limits_;
}

void SlowdownAdvice::advise(const DivisionLimit& limit) {
    {
        const std::lock_guard lock(mutex_);
        limits_.push_back(limit);
    }
    log::warning(log::Topic::Session, limit.text);
}

// The first frames decide: one shared frame among them silences the advice for good.
void SlowdownAdvice::countUnshared(uint32_t flags) {
    constexpr int64_t kFrames = 100;
    ++rangeFrames_;
    splitFrames_ += !(flags & wire::kNotSplit);
    if (!(flags & wire::kNotSplit))
        unsharedFrames_ = INT64_MIN / 2;
    else if (++unsharedFrames_ == kFrames * nodeCount_)
        advise(kDrawsUnshared);
}

} // namespace mural
