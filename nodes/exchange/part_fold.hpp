// Lays what one node has drawn over what another has, as one machine's depth test would have: pixel by pixel, a later one wins
// where the test passes. What was not drawn has the values that all were cleared to. Source: accuracy 4 (fold in draw order).
#pragma once

#include <cstddef>
#include <cstdint>

#include "compositor/kernels/depth_function.hpp"

namespace mural {

struct FoldRule {
    compositor::DepthFunction function = compositor::DepthFunction::Less; // Less, LessOrEqual, Greater or GreaterOrEqual
    uint32_t clearedColour = 0, clearedDepth = 0;
    bool deep = false; // the depth buffer has more than 24 bits
};

enum class FoldSide : uint8_t { Earlier, Later }; // when the other's were drawn

struct FoldRow {
    uint32_t* colour;
    uint32_t* depth;
    const uint32_t* otherColour;
    const uint32_t* otherDepth;
    size_t count;
};

void foldRow(const FoldRow& row, FoldSide side, const FoldRule& rule);

} // namespace mural
