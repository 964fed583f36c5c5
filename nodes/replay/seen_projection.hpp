// How a program looks at its scene: its projection, from whatever matrices it uses.
#pragma once

#include <cstddef>
#include <span>

namespace mural {

// In eye coordinates, looking along -z: x_clip = scaleX x + shearX w, y alike, w = -z, z_clip = depth w + a constant.
// Of a product with views and models that scale evenly, too: lengths there are the model's.
struct SeenProjection {
    double scaleX = 0; // 0: no perspective
    double scaleY = 0; // below 0: upside down
    double shearX = 0, shearY = 0;
    double depth = 0;
    double unit = 1; // length of w's row: what clip coordinates are multiplied by

    [[nodiscard]] bool perspective() const { return scaleX > 0; }
    // But for what rounding makes of products with moving models.
    [[nodiscard]] bool near(const SeenProjection& other) const;
};

// Columns of four, as OpenGL keeps them.
[[nodiscard]] SeenProjection seenProjection(const double (&matrix)[16]);
[[nodiscard]] SeenProjection seenProjection(const float (&matrix)[16]);

// Of sixteen floats or doubles somewhere in memory.
[[nodiscard]] SeenProjection seenProjectionAt(const std::byte* from, bool doubles, bool transposed);

// Of the last projection in `bytes`: sixteen floats that are nothing but a scale, a shear and depth. Other numbers rarely
// look so.
[[nodiscard]] SeenProjection lastProjectionIn(std::span<const std::byte> bytes);

} // namespace mural
