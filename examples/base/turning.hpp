// Placement of an object in front of the viewer.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "common/geometry/matrix4.hpp"

namespace mural::examples {

// Distance of the object's centre from the room's origin, and radius of the object there. Both eye and wall of a
// session without a configuration file see the whole object.
constexpr double kObjectDistance = 4, kObjectRadius = 1;

[[nodiscard]] inline Matrix4 scaling(double x, double y, double z) {
    Matrix4 matrix;
    matrix.m[0][0] = x;
    matrix.m[1][1] = y;
    matrix.m[2][2] = z;
    return matrix;
}

// Returns the rotation by `pitch` about the axis to the right, then by `turn` about the vertical axis, in degrees.
[[nodiscard]] inline Matrix4 rotation(double turn, double pitch) {
    const double a = turn * std::numbers::pi / 180, b = pitch * std::numbers::pi / 180;
    const Matrix4 about = Matrix4::rows({std::cos(a), 0, std::sin(a)}, {0, 1, 0}, {-std::sin(a), 0, std::cos(a)});
    const Matrix4 tilt = Matrix4::rows({1, 0, 0}, {0, std::cos(b), -std::sin(b)}, {0, std::sin(b), std::cos(b)});
    return about * tilt;
}

// Transforms an object with a centre and a radius to the room, and back.
struct Placement {
    Matrix4 toRoom, fromRoom;

    Placement(double turn, double pitch, const std::array<double, 3>& centre, double radius) {
        const double scale = kObjectRadius / radius;
        const Matrix4 turned = Matrix4::translation({0, 0, -kObjectDistance}) * rotation(turn, pitch);
        const Vector3 middle{centre[0], centre[1], centre[2]};
        toRoom = turned * scaling(scale, scale, scale) * Matrix4::translation(middle * -1);
        fromRoom = Matrix4::translation(middle) * scaling(1 / scale, 1 / scale, 1 / scale) * rigidInverse(turned);
    }
};

} // namespace mural::examples
