// Points and directions in the room, in metres: x to the right, y up, z towards the viewer.
#pragma once

#include <cmath>

namespace mural {

struct Vector3 {
    double x = 0;
    double y = 0;
    double z = 0;

    friend constexpr Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vector3 operator*(const Vector3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

[[nodiscard]] constexpr double dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] constexpr Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double length(const Vector3& a) { return std::sqrt(dot(a, a)); }
// Returns the unit vector in the direction of `a`; 0 0 0 stays 0 0 0.
[[nodiscard]] inline Vector3 normalized(const Vector3& a) {
    const double size = length(a);
    return size > 0 ? a * (1 / size) : Vector3{};
}

} // namespace mural
