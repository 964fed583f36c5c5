// OpenGL's depth functions, in the order of their GL numbers from GL_NEVER on, and what decides between two pixels.
#pragma once

#include <cstdint>

namespace mural::compositor {

enum class DepthFunction : uint8_t { Never, Less, Equal, LessOrEqual, Greater, NotEqual, GreaterOrEqual, Always };
constexpr int kDepthFunctions = 8;

enum class DepthFormat : uint8_t { D24S8, D32F };

// Which pixels were drawn at all. With All, a pixel nobody drew competes with the depth that it was cleared to: right for
// functions that the clear depth always fails. NotClear: those of another depth than clearBits. Stencil (D24S8): those whose
// stencil is not 0, for programs that draw at the clear depth (a sky at depth 1 under GL_LEQUAL). What was not drawn must be the
// same in all parts: cleared alike.
enum class Coverage : uint8_t { All, NotClear, Stencil };

struct DepthRule {
    DepthFunction function = DepthFunction::Less;
    DepthFormat format = DepthFormat::D32F;
    bool sourceIsLater = true; // in draw order
    Coverage coverage = Coverage::All;
    uint32_t clearBits = 0; // the word that the depth plane was cleared to
};

// Parts drawn apart and put together with this function give the picture drawn in one piece. Equal and NotEqual look at what
// other parts have left in the depth buffer.
[[nodiscard]] constexpr bool decomposable(DepthFunction f) { return f != DepthFunction::Equal && f != DepthFunction::NotEqual; }

} // namespace mural::compositor
