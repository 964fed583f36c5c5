// The place of a picture in the room: a wall given by three corners, or a projector. Lengths are in metres, angles in
// degrees. Omitted values are those of the default wall.
#pragma once

#include <optional>
#include <variant>

#include "balancer/config/source_position.hpp"
#include "common/geometry/vector3.hpp"

namespace mural::config {

enum class WallType : uint8_t {
    Fixed,
    Hmd, // moves with the head
};

struct Wall {
    Vector3 bottomLeft{-.8, -.5, -1};
    Vector3 bottomRight{.8, -.5, -1};
    Vector3 topLeft{-.8, .5, -1};
    WallType type = WallType::Fixed;
    SourcePosition at;
    friend bool operator==(const Wall&, const Wall&) = default;
};

struct Degrees2 {
    double x = 0;
    double y = 0;
    friend constexpr bool operator==(const Degrees2&, const Degrees2&) = default;
};

struct Projection {
    Vector3 origin;
    double distance = 1;
    Degrees2 fov{77.3196, 53.1301};
    Vector3 hpr; // heading (left is positive), pitch (up), roll (counter-clockwise)
    SourcePosition at;
    friend bool operator==(const Projection&, const Projection&) = default;
};

using ProjectionSurface = std::variant<Wall, Projection>;

} // namespace mural::config
