// How wide a projection sees: its scale of x, from whatever matrices a program uses. 0: no perspective.
#pragma once

#include <cstddef>
#include <span>

namespace mural {

// Columns of four, as OpenGL keeps them; any product that ends in a perspective projection, of views and models that
// scale evenly. A shear of the frustum does not count.
[[nodiscard]] double fieldScaleOf(const double (&matrix)[16]);
[[nodiscard]] double fieldScaleOf(const float (&matrix)[16]);

// Of sixteen floats or doubles somewhere in memory.
[[nodiscard]] double fieldScaleAt(const std::byte* from, bool doubles, bool transposed);

// Of the last projection in `bytes`: sixteen floats that are nothing but a scale, a shear and depth. Other numbers rarely
// look so.
[[nodiscard]] double lastProjectionIn(std::span<const std::byte> bytes);

} // namespace mural
