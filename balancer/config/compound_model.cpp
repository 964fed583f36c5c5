#include "balancer/config/compound_model.hpp"

#include <tuple>

namespace mural::config {

namespace {

// Compares member by member, because clang 14 rejects a defaulted comparison of a type that contains a list of itself.
// A member missing here is a compile error.
auto membersOf(const Compound& c) {
    const auto& [name, channel, tasks, eyes, buffers, viewport, range, period, phase, zoom, pixel, subPixel,
                 composition, surface, attributes, equalizers, swapBarrier, outputTiles, inputTiles, children,
                 outputFrames, inputFrames, at] = c;
    return std::tie(name, channel, tasks, eyes, buffers, viewport, range, period, phase, zoom, pixel, subPixel,
                    composition, surface, attributes, equalizers, swapBarrier, outputTiles, inputTiles, children,
                    outputFrames, inputFrames, at);
}

} // namespace

bool operator==(const Compound& a, const Compound& b) { return membersOf(a) == membersOf(b); }

} // namespace mural::config
