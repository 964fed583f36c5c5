#include "nodes/exchange/picture_part.hpp"

#include <algorithm>

namespace mural {

namespace {

template <class Passes> void merge(PicturePart& into, const PicturePart& later, uint32_t clearedColour, uint32_t clearedDepth, const Passes& passes) {
    const size_t count = std::min({into.colour.size(), into.depth.size(), later.colour.size(), later.depth.size()});
    for (size_t i = 0; i < count; ++i) {
        const bool drawn = later.depth[i] != clearedDepth || later.colour[i] != clearedColour;
        if (!drawn || !passes(later.depth[i], into.depth[i])) continue;
        into.colour[i] = later.colour[i];
        into.depth[i] = later.depth[i];
    }
}

} // namespace

void mergeByDepth(PicturePart& into, const PicturePart& later, compositor::DepthFunction function, uint32_t clearedColour, uint32_t clearedDepth) {
    using compositor::DepthFunction;
    const auto with = [&](const auto& passes) { merge(into, later, clearedColour, clearedDepth, passes); };
    switch (function) {
    case DepthFunction::Less: return with([](uint32_t a, uint32_t b) { return a < b; });
    case DepthFunction::LessOrEqual: return with([](uint32_t a, uint32_t b) { return a <= b; });
    case DepthFunction::Greater: return with([](uint32_t a, uint32_t b) { return a > b; });
    case DepthFunction::GreaterOrEqual: return with([](uint32_t a, uint32_t b) { return a >= b; });
    default: return; // draws by these are not shared
    }
}

} // namespace mural
