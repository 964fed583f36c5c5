// Column-major 4×4 matrices, as OpenGL requires them.
#pragma once

#include <array>
#include <cmath>

namespace programs {

using Matrix = std::array<float, 16>;

inline Matrix identity() { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }

inline Matrix multiply(const Matrix& a, const Matrix& b) {
    Matrix product = {};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 4; ++row) {
            for (std::size_t k = 0; k < 4; ++k) {
                product[column * 4 + row] += a[k * 4 + row] * b[column * 4 + k];
            }
        }
    }
    return product;
}

inline Matrix translation(float x, float y, float z) { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1}; }

inline Matrix scaling(float x, float y, float z) { return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1}; }

inline Matrix rotationZ(float radians) {
    const float c = std::cos(radians);
    const float s = std::sin(radians);
    return {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
}

inline Matrix rotationY(float radians) {
    const float c = std::cos(radians);
    const float s = std::sin(radians);
    return {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1};
}

inline Matrix perspective(float halfWidth, float halfHeight, float near, float far) {
    Matrix m = {};
    m[0] = near / halfWidth;
    m[5] = near / halfHeight;
    m[10] = -(far + near) / (far - near);
    m[11] = -1;
    m[14] = -2 * far * near / (far - near);
    return m;
}

} // namespace programs
