// 4x4 matrices of affine maps, row-major: row r, column c is m[r][c].
#pragma once

#include <array>

#include "common/geometry/vector3.hpp"

namespace mural {

struct Matrix4 {
    std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

    [[nodiscard]] static constexpr Matrix4 translation(const Vector3& by) {
        Matrix4 t;
        t.m[0][3] = by.x;
        t.m[1][3] = by.y;
        t.m[2][3] = by.z;
        return t;
    }
    // Returns the rotation that maps u, v, w to the axes.
    [[nodiscard]] static constexpr Matrix4 rows(const Vector3& u, const Vector3& v, const Vector3& w) {
        return {{{{u.x, u.y, u.z, 0}, {v.x, v.y, v.z, 0}, {w.x, w.y, w.z, 0}, {0, 0, 0, 1}}}};
    }
    friend constexpr Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
        Matrix4 product;
        for (size_t r = 0; r < 4; ++r) {
            for (size_t c = 0; c < 4; ++c) {
                double sum = 0;
                for (size_t i = 0; i < 4; ++i) sum += a.m[r][i] * b.m[i][c];
                product.m[r][c] = sum;
            }
        }
        return product;
    }
    friend constexpr bool operator==(const Matrix4&, const Matrix4&) = default;
};

[[nodiscard]] constexpr Vector3 transformPoint(const Matrix4& t, const Vector3& p) {
    const auto row = [&](size_t r) { return t.m[r][0] * p.x + t.m[r][1] * p.y + t.m[r][2] * p.z + t.m[r][3]; };
    return {row(0), row(1), row(2)};
}
[[nodiscard]] constexpr Vector3 transformDirection(const Matrix4& t, const Vector3& d) {
    const auto row = [&](size_t r) { return t.m[r][0] * d.x + t.m[r][1] * d.y + t.m[r][2] * d.z; };
    return {row(0), row(1), row(2)};
}

// Returns the inverse of a rotation with translation.
[[nodiscard]] constexpr Matrix4 rigidInverse(const Matrix4& t) {
    Matrix4 inverse;
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c) inverse.m[r][c] = t.m[c][r];
    }
    const Vector3 moved = transformDirection(inverse, {t.m[0][3], t.m[1][3], t.m[2][3]});
    inverse.m[0][3] = -moved.x;
    inverse.m[1][3] = -moved.y;
    inverse.m[2][3] = -moved.z;
    return inverse;
}

} // namespace mural
