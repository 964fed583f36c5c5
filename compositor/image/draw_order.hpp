// Which parts of a frame's draw list a picture holds. It travels with the picture, so that what comes of two pictures never
// depends on which of them arrived first.
#pragma once

#include <cstdint>

namespace mural::compositor {

// Parts first … end-1 of the draw list; of two pictures, the one with the lower numbers was to be drawn earlier.
struct DrawOrder {
    uint32_t first = 0;
    uint32_t end = 1;

    [[nodiscard]] constexpr bool empty() const { return end <= first; }
    friend constexpr bool operator==(const DrawOrder&, const DrawOrder&) = default;
};

// One is wholly before the other. What lies interleaved can't be told apart by depth alone where depths tie.
[[nodiscard]] constexpr bool apart(const DrawOrder& a, const DrawOrder& b) {
    return !a.empty() && !b.empty() && (a.end <= b.first || b.end <= a.first);
}
// Nothing can come between them.
[[nodiscard]] constexpr bool adjacent(const DrawOrder& a, const DrawOrder& b) {
    return !a.empty() && !b.empty() && (a.end == b.first || b.end == a.first);
}
// The order of both together; they are apart.
[[nodiscard]] constexpr DrawOrder joined(const DrawOrder& a, const DrawOrder& b) {
    return {a.first < b.first ? a.first : b.first, a.end > b.end ? a.end : b.end};
}

} // namespace mural::compositor
