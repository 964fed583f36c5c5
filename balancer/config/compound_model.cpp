#include "balancer/config/compound_model.hpp"

#include <tuple>

namespace mural::config {

namespace {

// Member by member: a defaulted comparison of a type that holds a list of its own kind stops clang 14. A member that is
// added and not named here is an error of the compiler's.
auto membersOf(const Compound& c) {
    const auto& [name, channel, tasks, eyes, buffers, viewport, range, period, phase, zoom, pixel, subPixel, composition, surface, attributes, equalizers,
                 swapBarrier, outputTiles, inputTiles, children, outputFrames, inputFrames, at] = c;
    return std::tie(name, channel, tasks, eyes, buffers, viewport, range, period, phase, zoom, pixel, subPixel, composition, surface, attributes, equalizers,
                    swapBarrier, outputTiles, inputTiles, children, outputFrames, inputFrames, at);
}

} // namespace

bool operator==(const Compound& a, const Compound& b) { return membersOf(a) == membersOf(b); }

} // namespace mural::config
