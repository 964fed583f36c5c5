// OpenGL's depth functions, in the order of their GL values from GL_NEVER on, and the rule that selects between two
// pixels.
#pragma once

#include <cstdint>

namespace mural::compositor {

enum class DepthFunction : uint8_t { Never, Less, Equal, LessOrEqual, Greater, NotEqual, GreaterOrEqual, Always };
constexpr int kDepthFunctions = 8;

enum class DepthFormat : uint8_t { D24S8, D32F };

// The drawn pixels of a part. All: undrawn pixels compete with the clear depth, which is right for functions that the
// clear depth always fails. NotClear: pixels whose depth differs from clearBits. Stencil (D24S8): pixels with a
// non-zero stencil, for programs that draw at the clear depth (a sky at depth 1 under GL_LEQUAL). Undrawn pixels must
// be equal in all parts.
enum class Coverage : uint8_t { All, NotClear, Stencil };

struct DepthRule {
    DepthFunction function = DepthFunction::Less;
    DepthFormat format = DepthFormat::D32F;
    bool sourceIsLater = true; // in draw order
    Coverage coverage = Coverage::All;
    uint32_t clearBits = 0; // clear value of the depth plane
};

// Returns true if compositing separately drawn parts gives the picture drawn as a whole. Equal and NotEqual depend on
// depths left by other parts.
[[nodiscard]] constexpr bool decomposable(DepthFunction f) {
    return f != DepthFunction::Equal && f != DepthFunction::NotEqual;
}

} // namespace mural::compositor
