// The part of the scene that a channel draws in sort-last decompositions: from start to end, the whole is 0 to 1.
// Source: thesis, "Compounds": range.
#pragma once

#include <algorithm>
#include <cstdint>

namespace mural {

struct Range {
    double start = 0;
    double end = 1;

    [[nodiscard]] constexpr bool empty() const { return !(end > start); }
    [[nodiscard]] constexpr bool full() const { return start == 0 && end == 1; }
    friend constexpr bool operator==(const Range&, const Range&) = default;
};

// Returns `inner`, which is relative to `outer`, relative to the whole. An end equal to `outer`'s end keeps the same
// number. Otherwise 0.3 + (0.9 - 0.3) would differ from 0.9, and a range that begins at 0.9 would leave a gap.
[[nodiscard]] constexpr Range compose(const Range& outer, const Range& inner) {
    const double size = outer.end - outer.start;
    const auto at = [&](double place) { return place == 1 ? outer.end : outer.start + place * size; };
    return {at(inner.start), at(inner.end)};
}

// Returns the number of elements, out of `count`, before a position. A position within rounding error of an element's
// edge counts as on it, as in pixelEdge, so adjacent ranges cover each element exactly once.
[[nodiscard]] inline uint64_t countBefore(double place, uint64_t count) {
    if (!(place > 0)) return 0;
    if (place >= 1) return count;
    const auto whole = static_cast<double>(count);
    const double before = place * whole + std::max(1e-6, whole * 1e-15);
    return before >= whole ? count : static_cast<uint64_t>(before);
}

} // namespace mural
