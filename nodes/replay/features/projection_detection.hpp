// Recognises a program's projection in arbitrary matrices.
#pragma once

#include <cstddef>
#include <span>

namespace mural {

// A projection in eye coordinates, looking along -z: x_clip = scaleX x + shearX w, y_clip likewise, w = -z, z_clip =
// depth w + constant. Also represents products with view and model matrices that scale uniformly. Lengths are then in
// units of the model.
struct ProjectionDetector {
    double scaleX = 0; // 0: no perspective
    double scaleY = 0; // negative: upside down
    double shearX = 0, shearY = 0;
    double depth = 0;
    double unit = 1; // length of w's row: the factor of clip coordinates

    [[nodiscard]] bool perspective() const { return scaleX > 0; }
    // Equality up to the rounding of products with moving models.
    [[nodiscard]] bool isClose(const ProjectionDetector& other) const;
};

// Column-major, as in OpenGL.
[[nodiscard]] ProjectionDetector seenProjection(const double (&matrix)[16]);
[[nodiscard]] ProjectionDetector seenProjection(const float (&matrix)[16]);

// Reads sixteen floats or doubles at any alignment.
[[nodiscard]] ProjectionDetector seenProjectionAt(const std::byte* from, bool doubles, bool transposed);

// The last projection in `bytes`: sixteen floats that consist of scale, shear and depth only. Other data rarely
// matches.
[[nodiscard]] ProjectionDetector lastProjectionIn(std::span<const std::byte> bytes);

} // namespace mural
