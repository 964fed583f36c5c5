// Arguments of glFrustum and glOrtho: edges on the near plane, near and far distance.
#pragma once

namespace mural {

struct Frustum {
    double left = 0;
    double right = 0;
    double bottom = 0;
    double top = 0;
    double nearPlane = 0;
    double farPlane = 0;

    [[nodiscard]] constexpr double width() const { return right - left; }
    [[nodiscard]] constexpr double height() const { return top - bottom; }
    friend constexpr bool operator==(const Frustum&, const Frustum&) = default;
};

} // namespace mural
