// Merges the parts of two nodes as one depth test would: per pixel, a later fragment wins if the test passes. Undrawn
// pixels hold the common clear values. See docs/architecture/sort-last.md.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compositor/kernels/depth_function.hpp"

namespace mural {

struct CompositeRule {
    // Less, LessOrEqual, Greater or GreaterOrEqual
    compositor::DepthFunction function = compositor::DepthFunction::Less;
    uint32_t clearedColour = 0, clearedDepth = 0;
    bool deep = false;          // the depth buffer has more than 24 bits
    bool blends = false;        // premultiplied colours, the later over the earlier; the depths do not matter
    bool hasHalfFloats = false; // requires blends: colours are half floats, and the clear colour is 0

    [[nodiscard]] size_t colourWords() const { return hasHalfFloats ? 2 : 1; } // per pixel
};

enum class LayerOrder : uint8_t { Earlier, Later }; // draw order of the other part

struct CompositeRow {
    uint32_t* colour;
    uint32_t* depth; // null, as otherDepth, if the rule blends
    const uint32_t* otherColour;
    const uint32_t* otherDepth;
    size_t count;
};

void compositeRow(const CompositeRow& row, LayerOrder side, const CompositeRule& rule);

} // namespace mural
