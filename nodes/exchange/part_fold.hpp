// Merges the parts of two nodes as one depth test would: per pixel, a later fragment wins if the test passes. Undrawn
// pixels hold the common clear values. See docs/architecture/sort-last.md.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compositor/kernels/depth_function.hpp"

namespace mural {

struct FoldRule {
    // Less, LessOrEqual, Greater or GreaterOrEqual
    compositor::DepthFunction function = compositor::DepthFunction::Less;
    uint32_t clearedColour = 0, clearedDepth = 0;
    bool deep = false; // the depth buffer has more than 24 bits
};

enum class FoldSide : uint8_t { Earlier, Later }; // draw order of the other part

struct FoldRow {
    uint32_t* colour;
    uint32_t* depth;
    const uint32_t* otherColour;
    const uint32_t* otherDepth;
    size_t count;
};

void foldRow(const FoldRow& row, FoldSide side, const FoldRule& rule);

} // namespace mural
