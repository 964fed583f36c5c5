#include "balancer/config/screen.hpp"

#include <numbers>

namespace mural::config {

namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

// Returns the rotation of the room for a projector with this heading, pitch and roll.
Matrix4 turnOf(const Vector3& hpr) {
    const double h = radians(hpr.x), p = radians(hpr.y), r = radians(hpr.z);
    const Matrix4 head = Matrix4::rows({std::cos(h), 0, -std::sin(h)}, {0, 1, 0}, {std::sin(h), 0, std::cos(h)});
    const Matrix4 pitch = Matrix4::rows({1, 0, 0}, {0, std::cos(p), std::sin(p)}, {0, -std::sin(p), std::cos(p)});
    const Matrix4 roll = Matrix4::rows({std::cos(r), std::sin(r), 0}, {-std::sin(r), std::cos(r), 0}, {0, 0, 1});
    return roll * pitch * head;
}

Vector3 rowOf(const Matrix4& t, size_t row) { return {t.m[row][0], t.m[row][1], t.m[row][2]}; }

} // namespace

bool Screen::usable() const {
    constexpr double kSquare = 1e-3; // tolerance: a millimetre per metre
    constexpr double kLargest = 1e6; // in metres; a field of view of 180 degrees exceeds it
    return width > 0 && height > 0 && width < kLargest && height < kLargest && std::abs(dot(right, up)) < kSquare;
}

Matrix4 Screen::fromRoom() const { return Matrix4::rows(right, up, normal) * Matrix4::translation(center * -1); }

Screen Screen::part(const Viewport& area) const {
    Screen cut = *this;
    cut.center = center + right * ((area.x + area.w / 2 - .5) * width) + up * ((area.y + area.h / 2 - .5) * height);
    cut.width = width * area.w;
    cut.height = height * area.h;
    return cut;
}

Screen screenOf(const Wall& wall) {
    const Vector3 bottom = wall.bottomRight - wall.bottomLeft;
    const Vector3 side = wall.topLeft - wall.bottomLeft;
    Screen s;
    s.center = (wall.bottomRight + wall.topLeft) * .5;
    s.right = normalized(bottom);
    s.up = normalized(side);
    s.normal = normalized(cross(s.right, s.up));
    s.width = length(bottom);
    s.height = length(side);
    s.type = wall.type;
    return s;
}

Screen screenOf(const Projection& projection) {
    const Matrix4 turn = turnOf(projection.hpr);
    Screen s;
    s.right = rowOf(turn, 0);
    s.up = rowOf(turn, 1);
    s.normal = rowOf(turn, 2);
    s.center = projection.origin - s.normal * projection.distance;
    s.width = 2 * projection.distance * std::tan(radians(projection.fov.x) / 2);
    s.height = 2 * projection.distance * std::tan(radians(projection.fov.y) / 2);
    return s;
}

Screen screenOf(const ProjectionSurface& surface) {
    return std::visit([](const auto& s) { return screenOf(s); }, surface);
}

} // namespace mural::config
