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

void mergeByDepth(PicturePart& into, const PicturePart& later, DepthOrder order, uint32_t clearedColour, uint32_t clearedDepth) {
    switch (order) {
    case DepthOrder::Less: return merge(into, later, clearedColour, clearedDepth, [](uint32_t a, uint32_t b) { return a < b; });
    case DepthOrder::LessOrEqual: return merge(into, later, clearedColour, clearedDepth, [](uint32_t a, uint32_t b) { return a <= b; });
    case DepthOrder::Greater: return merge(into, later, clearedColour, clearedDepth, [](uint32_t a, uint32_t b) { return a > b; });
    case DepthOrder::GreaterOrEqual: return merge(into, later, clearedColour, clearedDepth, [](uint32_t a, uint32_t b) { return a >= b; });
    }
}

} // namespace mural
