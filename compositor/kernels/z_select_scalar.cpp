// Depth compositing pixel by pixel: the reference for the vector code of z_select.cpp.
#include <bit>
#include <cmath>
#include <cstring>

#include "compositor/kernels/z_select.hpp"

namespace mural::compositor {

namespace {

bool passes(DepthFunction f, uint32_t later, uint32_t earlier) {
    switch (f) {
    case DepthFunction::Never: return false;
    case DepthFunction::Less: return later < earlier;
    case DepthFunction::Equal: return later == earlier;
    case DepthFunction::LessOrEqual: return later <= earlier;
    case DepthFunction::Greater: return later > earlier;
    case DepthFunction::NotEqual: return later != earlier;
    case DepthFunction::GreaterOrEqual: return later >= earlier;
    case DepthFunction::Always: return true;
    }
    return false;
}

bool passes(DepthFunction f, float later, float earlier) {
    const bool onlyEarlierIsNan = std::isnan(earlier) && !std::isnan(later);
    switch (f) {
    case DepthFunction::Never: return false;
    case DepthFunction::Less: return later < earlier || onlyEarlierIsNan;
    case DepthFunction::Equal: return later == earlier;
    case DepthFunction::LessOrEqual: return later <= earlier || onlyEarlierIsNan;
    case DepthFunction::Greater: return later > earlier || onlyEarlierIsNan;
    case DepthFunction::NotEqual: return later != earlier;
    case DepthFunction::GreaterOrEqual: return later >= earlier || onlyEarlierIsNan;
    case DepthFunction::Always: return true;
    }
    return false;
}

bool laterWins(const DepthRule& rule, uint32_t later, uint32_t earlier) {
    if (rule.format == DepthFormat::D24S8) return passes(rule.function, later >> 8, earlier >> 8);
    return passes(rule.function, std::bit_cast<float>(later), std::bit_cast<float>(earlier));
}

bool drawn(const DepthRule& rule, uint32_t depth) {
    switch (rule.coverage) {
    case Coverage::All: return true;
    case Coverage::NotClear:
        return rule.format == DepthFormat::D24S8 ? depth >> 8 != rule.clearBits >> 8 : depth != rule.clearBits;
    case Coverage::Stencil: return (depth & 0xff) != 0;
    }
    return true;
}

bool sourceWins(const DepthRule& rule, uint32_t source, uint32_t there) {
    if (!drawn(rule, source)) return false;
    if (!drawn(rule, there)) return true;
    return rule.sourceIsLater ? laterWins(rule, source, there) : !laterWins(rule, there, source);
}

} // namespace

void zSelectScalar(const ZArea& area, const DepthRule& rule) {
    for (size_t y = 0; y < area.rows; ++y) {
        const ZArea row = area.row(y);
        for (size_t i = 0; i < row.columns; ++i) {
            if (!sourceWins(rule, row.sourceDepth[i], row.depth[i])) continue;
            row.depth[i] = row.sourceDepth[i];
            if (row.colour)
                std::memcpy(row.colour + i * row.colourBytes, row.sourceColour + i * row.colourBytes, row.colourBytes);
        }
    }
}

} // namespace mural::compositor
