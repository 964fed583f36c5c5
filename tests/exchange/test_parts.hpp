// Pictures as nodes draw them: cleared, then drawn with a depth function, with many equal depths and some at the clear
// depth.
#pragma once

#include <random>

#include "nodes/exchange/part_composition.hpp"
#include "nodes/exchange/picture_part.hpp"

namespace mural::test {

constexpr compositor::DepthFunction kOrders[] = {
    compositor::DepthFunction::Less, compositor::DepthFunction::LessOrEqual, compositor::DepthFunction::Greater,
    compositor::DepthFunction::GreaterOrEqual};

// As OpenGL converts 24 bits of depth to 32.
inline uint32_t widened(uint32_t depth24) { return depth24 << 8 | depth24 >> 16; }

inline CompositeRule ruleOf(compositor::DepthFunction function, bool deep) {
    const bool less = function == compositor::DepthFunction::Less || function == compositor::DepthFunction::LessOrEqual;
    return {function, 0xff102030u, less ? 0xffffffffu : 0u, deep};
}

inline bool passes(compositor::DepthFunction f, uint32_t later, uint32_t earlier) {
    switch (f) {
    case compositor::DepthFunction::Less: return later < earlier;
    case compositor::DepthFunction::LessOrEqual: return later <= earlier;
    case compositor::DepthFunction::Greater: return later > earlier;
    default: return later >= earlier;
    }
}

// Draws one fragment with the depth test.
inline void draw(PicturePart& part, size_t at, uint32_t colour, uint32_t depth, const CompositeRule& rule) {
    if (!passes(rule.function, depth, part.depth[at])) return;
    part.colour[at] = colour;
    part.depth[at] = depth;
}

inline PicturePart clearedPart(int32_t width, int32_t height, const CompositeRule& rule) {
    PicturePart part;
    part.id = {3, 7, {5, 9, width, height}};
    part.colour.assign(static_cast<size_t>(width * height), rule.clearedColour);
    part.depth.assign(part.colour.size(), rule.clearedDepth);
    return part;
}

struct Fragment {
    size_t at;
    uint32_t colour, depth;
};

// Few depths, so many are equal; at the clear depth with another colour than the clear's.
inline std::vector<Fragment> fragmentsOf(std::mt19937& random, size_t pixels, const CompositeRule& rule) {
    std::vector<Fragment> fragments;
    for (size_t i = 0; i < pixels; ++i) {
        const uint32_t level = random() % 12;
        uint32_t depth = rule.deep ? 0x80000000u + level % 4 : widened(0x400000 + level % 4);
        if (level == 0) depth = rule.clearedDepth;
        if (level == 1) depth = rule.deep ? static_cast<uint32_t>(random()) : widened(random() & 0xffffff);
        fragments.push_back({random() % pixels, static_cast<uint32_t>(random()) | 1u, depth});
    }
    return fragments;
}

} // namespace mural::test
