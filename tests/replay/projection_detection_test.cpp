// Detection of projection matrices in a program's uniforms and buffers.
#include "nodes/replay/features/projection_detection.hpp"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "tests/replay/frustum_matrix.hpp"

namespace mural {
namespace {

using test::frustumMatrix;

using Matrix = std::array<double, 16>; // columns

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix m{};
    for (size_t c = 0; c < 4; ++c)
        for (size_t r = 0; r < 4; ++r)
            for (size_t k = 0; k < 4; ++k) m[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
    return m;
}
double scaleOf(const Matrix& m) {
    double plain[16];
    std::copy(m.begin(), m.end(), plain);
    return seenProjection(plain).scaleX;
}
Matrix turned(double angle) {
    return {std::cos(angle), 0, -std::sin(angle), 0, 0, 1, 0, 0, std::sin(angle), 0, std::cos(angle), 0, 3, -2, -9, 1};
}

TEST(ProjectionDetector, recognisesPlainProjections) {
    EXPECT_DOUBLE_EQ(scaleOf(frustumMatrix(-2, 2, -1, 1, 3, 50)), 1.5);
    EXPECT_NEAR(scaleOf(frustumMatrix(-1, 3, -1, 1, 3, 50)), 1.5, 1e-12) << "sheared";
    EXPECT_NEAR(scaleOf(frustumMatrix(-2, 2, -1, 1, 3, 1e9)), 1.5, 1e-12);
}

TEST(ProjectionDetector, recognisesProductsWithViewsAndModels) {
    const Matrix p = frustumMatrix(-1, 3, -1, 1, 3, 50);
    EXPECT_NEAR(scaleOf(product(p, turned(0.7))), 1.5, 1e-12);
    Matrix small = turned(-1.1);
    for (size_t i = 0; i < 12; ++i) small[i] *= 0.01;
    EXPECT_NEAR(scaleOf(product(p, small)), 1.5, 1e-9);
}

TEST(ProjectionDetector, rejectsMatricesWithoutPerspective) {
    EXPECT_EQ(scaleOf(turned(0.3)), 0);
    EXPECT_EQ(scaleOf({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}), 0);
    EXPECT_EQ(scaleOf({}), 0);
    Matrix bad = frustumMatrix(-1, 1, -1, 1, 1, 2);
    bad[5] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(scaleOf(bad), 0);
    bad[5] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(scaleOf(bad), 0);
}

TEST(ProjectionDetector, readsAllLayoutsOfUniforms) {
    const Matrix p = product(frustumMatrix(-2, 2, -1, 1, 3, 50), turned(0.2));
    float single[16], turnedOver[16];
    for (size_t i = 0; i < 16; ++i)
        single[i] = static_cast<float>(p[i]), turnedOver[i % 4 * 4 + i / 4] = static_cast<float>(p[i]);
    EXPECT_NEAR(seenProjectionAt(reinterpret_cast<const std::byte*>(single), false, false).scaleX, 1.5, 1e-5);
    EXPECT_NEAR(seenProjectionAt(reinterpret_cast<const std::byte*>(turnedOver), false, true).scaleX, 1.5, 1e-5);
    EXPECT_NEAR(seenProjectionAt(reinterpret_cast<const std::byte*>(p.data()), true, false).scaleX, 1.5, 1e-12);
}

TEST(ProjectionDetector, findsProjectionsInBuffers) {
    const Matrix p = frustumMatrix(-2, 2, -1, 1, 3, 50);
    std::vector<float> values(7, 0.25f);
    for (const double v : p) values.push_back(static_cast<float>(v));
    values.insert(values.end(), 9, 1.0f);
    EXPECT_NEAR(lastProjectionIn(std::as_bytes(std::span(values))).scaleX, 1.5, 1e-6);
    values.resize(7 + 15);
    EXPECT_EQ(lastProjectionIn(std::as_bytes(std::span(values))).scaleX, 0) << "cut off";
    EXPECT_EQ(lastProjectionIn({}).scaleX, 0);
    const std::vector<float> zeros(64, 0.0f);
    EXPECT_EQ(lastProjectionIn(std::as_bytes(std::span(zeros))).scaleX, 0);
}

} // namespace
} // namespace mural
