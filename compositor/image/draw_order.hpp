// The parts of a frame's draw list that a picture contains. It travels with the picture, so the result of compositing
// never depends on the order of arrival.
#pragma once

#include <cstdint>

namespace mural::compositor {

// Parts first ... end-1 of the draw list; lower parts are drawn earlier.
struct DrawOrder {
    uint32_t first = 0;
    uint32_t end = 1;

    [[nodiscard]] constexpr bool empty() const { return end <= first; }
    friend constexpr bool operator==(const DrawOrder&, const DrawOrder&) = default;
};

// Returns true if one is entirely before the other. Interleaved parts cannot be composited by depth where depths are
// equal.
[[nodiscard]] constexpr bool apart(const DrawOrder& a, const DrawOrder& b) {
    return !a.empty() && !b.empty() && (a.end <= b.first || b.end <= a.first);
}
// Returns true if no part lies between them.
[[nodiscard]] constexpr bool adjacent(const DrawOrder& a, const DrawOrder& b) {
    return !a.empty() && !b.empty() && (a.end == b.first || b.end == a.first);
}
// Returns the order of both. Requires apart(a, b).
[[nodiscard]] constexpr DrawOrder joined(const DrawOrder& a, const DrawOrder& b) {
    return {a.first < b.first ? a.first : b.first, a.end > b.end ? a.end : b.end};
}

} // namespace mural::compositor
