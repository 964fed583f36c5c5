#include "nodes/replay/features/projection_detection.hpp"

#include <cmath>
#include <cstring>

namespace mural {

namespace {

struct Row {
    double x, y, z;
    Row(const double (&m)[16], size_t row) : x(m[row]), y(m[4 + row]), z(m[8 + row]) {}
};
double dot(const Row& a, const Row& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double determinant(const Row& a, const Row& b, const Row& c) {
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

// The component of a row along the fourth row (shear), and the length of the remainder (scale).
struct Axis {
    double shear, scale;
    Axis(Row row, const Row& fourth, double ww) : shear(dot(row, fourth) / ww) {
        row.x -= shear * fourth.x;
        row.y -= shear * fourth.y;
        row.z -= shear * fourth.z;
        scale = std::sqrt(dot(row, row) / ww);
    }
};

template <class T> ProjectionDetector projectionFrom(const std::byte* from, bool transposed) {
    T values[16];
    std::memcpy(values, from, sizeof values);
    double m[16];
    for (size_t i = 0; i < 16; ++i) m[i] = static_cast<double>(transposed ? values[i % 4 * 4 + i / 4] : values[i]);
    return seenProjection(m);
}

bool isPlausible(const float (&m)[16]) {
    for (const int zero : {1, 2, 3, 4, 6, 7, 12, 13, 15})
        if (m[zero] != 0) return false;
    return std::fabs(m[11]) == 1 && m[0] != 0 && m[5] != 0 && m[14] != 0;
}

} // namespace

bool ProjectionDetector::isClose(const ProjectionDetector& o) const {
    const auto same = [](double a, double b) { return std::fabs(a - b) <= 1e-4 * std::fmax(1, std::fabs(a)); };
    return same(scaleX, o.scaleX) && same(scaleY, o.scaleY) && same(shearX, o.shearX) && same(shearY, o.shearY) &&
           same(depth, o.depth);
}

ProjectionDetector seenProjection(const double (&m)[16]) {
    for (const double value : m)
        if (!std::isfinite(value)) return {};
    const Row fourth(m, 3);
    const double ww = dot(fourth, fourth);
    if (ww <= 1e-18) return {};
    const Axis x(Row(m, 0), fourth, ww), y(Row(m, 1), fourth, ww);
    if (x.scale <= 1e-9 || y.scale <= 1e-9) return {};
    const bool mirrored = determinant(Row(m, 0), Row(m, 1), fourth) > 0; // w is -z
    return {x.scale, mirrored ? -y.scale : y.scale, x.shear, y.shear, dot(Row(m, 2), fourth) / ww, std::sqrt(ww)};
}

ProjectionDetector seenProjection(const float (&matrix)[16]) {
    double m[16];
    for (size_t i = 0; i < 16; ++i) m[i] = static_cast<double>(matrix[i]);
    return seenProjection(m);
}

ProjectionDetector seenProjectionAt(const std::byte* from, bool doubles, bool transposed) {
    return doubles ? projectionFrom<double>(from, transposed) : projectionFrom<float>(from, transposed);
}

ProjectionDetector lastProjectionIn(std::span<const std::byte> bytes) {
    ProjectionDetector last;
    for (size_t at = 0; at + 64 <= bytes.size(); at += 4) {
        float m[16];
        std::memcpy(m, bytes.data() + at, sizeof m);
        if (!isPlausible(m)) continue;
        const ProjectionDetector seen = seenProjection(m);
        if (seen.perspective()) last = seen;
    }
    return last;
}

} // namespace mural
