#include "nodes/exchange/part_composition.hpp"

#include "compositor/kernels/blend_over.hpp"
#include "compositor/kernels/z_select.hpp"

namespace mural {

namespace {

using compositor::DepthFunction;

// OpenGL returns depths of up to 24 bits as 32-bit values. The upper 24 bits are distinct and in depth order.
constexpr unsigned kSpareBits = 8;

template <class Passes>
void foldWith(const CompositeRow& r, LayerOrder side, const CompositeRule& rule, const Passes& passes) {
    for (size_t i = 0; i < r.count; ++i) {
        if (r.otherDepth[i] == rule.clearedDepth && r.otherColour[i] == rule.clearedColour) continue;
        const bool own = r.depth[i] != rule.clearedDepth || r.colour[i] != rule.clearedColour;
        if (own &&
            !(side == LayerOrder::Later ? passes(r.otherDepth[i], r.depth[i]) : !passes(r.depth[i], r.otherDepth[i])))
            continue;
        r.colour[i] = r.otherColour[i];
        r.depth[i] = r.otherDepth[i];
    }
}

// Scalar path for depths of more than 24 bits. The compositor's kernel has no format for them (32-bit integers; its
// 32-bit depths are floats).
void foldDeep(const CompositeRow& r, LayerOrder side, const CompositeRule& rule) {
    switch (rule.function) {
    case DepthFunction::Less:
        return foldWith(r, side, rule, [](uint32_t later, uint32_t earlier) { return later < earlier; });
    case DepthFunction::LessOrEqual:
        return foldWith(r, side, rule, [](uint32_t later, uint32_t earlier) { return later <= earlier; });
    case DepthFunction::Greater:
        return foldWith(r, side, rule, [](uint32_t later, uint32_t earlier) { return later > earlier; });
    case DepthFunction::GreaterOrEqual:
        return foldWith(r, side, rule, [](uint32_t later, uint32_t earlier) { return later >= earlier; });
    default: return; // draws with these functions are not divided
    }
}

// A pixel drawn at the clear depth (a sky with GL_LEQUAL) differs from an undrawn one only by its colour, which the
// kernel ignores. Only pixels with the clear depth can lie below it.
void foldAtClearDepth(const CompositeRow& r, LayerOrder side, const CompositeRule& rule) {
    const uint32_t clear = rule.clearedDepth >> kSpareBits;
    for (size_t i = 0; i < r.count; ++i) {
        if (r.otherDepth[i] >> kSpareBits != clear || r.otherColour[i] == rule.clearedColour ||
            r.depth[i] >> kSpareBits != clear)
            continue;
        if (side == LayerOrder::Later || r.colour[i] == rule.clearedColour) r.colour[i] = r.otherColour[i];
    }
}

} // namespace

void compositeRow(const CompositeRow& row, LayerOrder side, const CompositeRule& rule) {
    if (rule.blends) {
        const auto format = rule.hasHalfFloats ? compositor::PlaneFormat::Rgba16F : compositor::PlaneFormat::Rgba8;
        compositor::blendOverRow(
            format, reinterpret_cast<std::byte*>(row.colour), reinterpret_cast<const std::byte*>(row.otherColour),
            row.count, side == LayerOrder::Later ? compositor::SourceSide::InFront : compositor::SourceSide::Behind);
        return;
    }
    if (rule.deep) return foldDeep(row, side, rule);
    compositor::ZArea z;
    z.depth = row.depth;
    z.colour = reinterpret_cast<std::byte*>(row.colour);
    z.sourceDepth = row.otherDepth;
    z.sourceColour = reinterpret_cast<const std::byte*>(row.otherColour);
    z.columns = row.count;
    compositor::DepthRule how;
    how.function = rule.function;
    how.format = compositor::DepthFormat::D24S8;
    how.sourceIsLater = side == LayerOrder::Later;
    how.coverage = compositor::Coverage::NotClear;
    how.clearBits = rule.clearedDepth;
    compositor::zSelect(z, how);
    const bool equalPasses =
        rule.function == DepthFunction::LessOrEqual || rule.function == DepthFunction::GreaterOrEqual;
    if (equalPasses) foldAtClearDepth(row, side, rule);
}

} // namespace mural
