// The part of the scene that a channel draws when work is divided by data: from start to end, the whole is 0 to 1.
// Source: thesis, "Compounds": range.
#pragma once

namespace mural {

struct Range {
    double start = 0;
    double end = 1;

    [[nodiscard]] constexpr bool empty() const { return !(end > start); }
    [[nodiscard]] constexpr bool full() const { return start == 0 && end == 1; }
    friend constexpr bool operator==(const Range&, const Range&) = default;
};

// `inner`, given as part of `outer`, as part of what `outer` is a part of.
[[nodiscard]] constexpr Range compose(const Range& outer, const Range& inner) {
    const double size = outer.end - outer.start;
    return {outer.start + inner.start * size, outer.start + inner.end * size};
}

} // namespace mural
