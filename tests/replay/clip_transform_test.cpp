// Transformed clip coordinates compared with the coordinates of the intended matrices.
#include "nodes/replay/features/clip_transform.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "tests/replay/frustum_matrix.hpp"

namespace mural {
namespace {

using Point = std::array<double, 4>;

struct Projection {
    double l, r, b, t, n, f;
    [[nodiscard]] std::array<double, 16> matrix() const { return test::frustumMatrix(l, r, b, t, n, f); }
};

Point times(const double (&m)[16], const Point& p) {
    Point out{};
    for (size_t c = 0; c < 4; ++c)
        for (size_t r = 0; r < 4; ++r) out[r] += m[4 * c + r] * p[c];
    return out;
}

// As in the shader.
Point moved(const ClipTransform& m, const Point& p) {
    const auto by = [&](const std::array<double, 4>& row) {
        return row[0] * p[0] + row[1] * p[1] + row[2] * p[3] + row[3];
    };
    return {p[0] + by(m.x), p[1] + by(m.y), p[2] + m.z * by(m.w), p[3] + by(m.w)};
}

class ClipTransformTest : public testing::Test {
protected:
    std::mt19937 numbers{7};
    double random(double from, double to) { return std::uniform_real_distribution<double>(from, to)(numbers); }
    Projection anyProjection() {
        return {random(-3, -0.5), random(0.5, 3), random(-2, -0.4), random(0.4, 2), random(0.1, 2), random(10, 1000)};
    }
};

Matrix4 turn(double about, double up) {
    const Matrix4 y =
        Matrix4::rows({std::cos(about), 0, -std::sin(about)}, {0, 1, 0}, {std::sin(about), 0, std::cos(about)});
    return Matrix4::rows({1, 0, 0}, {0, std::cos(up), -std::sin(up)}, {0, std::sin(up), std::cos(up)}) * y;
}

TEST_F(ClipTransformTest, matchesScreensOfARoom) {
    for (int i = 0; i < 2000; ++i) {
        const Projection own = anyProjection();
        ScreenView s;
        s.area = {random(0, 0.5), random(0, 0.5), random(0.1, 0.5), random(0.1, 0.5)};
        s.left = random(-2, 0.5), s.right = s.left + random(0.3, 3), s.bottom = random(-2, 0.5),
        s.top = s.bottom + random(0.3, 3);
        s.fromProgram =
            Matrix4::translation({random(-1, 1), random(-1, 1), random(-1, 1)}) * turn(random(-3, 3), random(-1, 1));
        double m[16];
        std::ranges::copy(own.matrix(), m);
        const ProjectionDetector seen = seenProjection(m);
        const Vector3 eye{random(-9, 9), random(-9, 9), random(-30, -1)};
        const Point clip = times(m, {eye.x, eye.y, eye.z, 1});

        const Vector3 there = transformPoint(s.fromProgram, eye);
        const double x = (2 * there.x + (s.right + s.left) * there.z) / (s.right - s.left),
                     y = (2 * there.y + (s.top + s.bottom) * there.z) / (s.top - s.bottom);
        const double w = -there.z;
        const double placedX = s.area.w * x + (2 * s.area.x + s.area.w - 1) * w,
                     placedY = s.area.h * y + (2 * s.area.y + s.area.h - 1) * w;
        const double depth = own.matrix()[10] * there.z + own.matrix()[14]; // with the program's near and far planes

        const Point got = moved(screenMove(seen, s), clip);
        const double scale = 1e-9 * (std::fabs(clip[3]) + std::fabs(w) + 1) * 100;
        EXPECT_NEAR(got[0], placedX, scale);
        EXPECT_NEAR(got[1], placedY, scale);
        EXPECT_NEAR(got[2], depth, scale);
        EXPECT_NEAR(got[3], w, scale);

        screenMove(seen, s).apply(m, seen.unit);
        const Point whole = times(m, {eye.x, eye.y, eye.z, 1});
        for (size_t k = 0; k < 4; ++k) EXPECT_NEAR(whole[k], got[k], scale);
        if (testing::Test::HasFailure()) FAIL() << "case " << i;
    }
}

// A screen in the program's assumed place shows the program's picture.
TEST_F(ClipTransformTest, isTheIdentityForTheProgramsOwnScreen) {
    for (int i = 0; i < 100; ++i) {
        const Projection own = anyProjection();
        double m[16];
        std::ranges::copy(own.matrix(), m);
        ScreenView s;
        s.left = own.l / own.n, s.right = own.r / own.n, s.bottom = own.b / own.n, s.top = own.t / own.n;
        const ClipTransform move = screenMove(seenProjection(m), s);
        for (const auto& row : {move.x, move.y, move.w})
            for (const double value : row) EXPECT_NEAR(value, 0, 1e-12);
    }
}

TEST_F(ClipTransformTest, matchesEyesInFrontOfOneScreen) {
    const Projection own{-2, 2, -1, 1, 1.5, 60};
    double m[16], shifted[16];
    std::ranges::copy(own.matrix(), m);
    const ProjectionDetector seen = seenProjection(m);
    const double offset = 0.3, focus = 8, edge = offset * own.n / focus;
    std::ranges::copy(Projection{own.l - edge, own.r - edge, own.b, own.t, own.n, own.f}.matrix(), shifted);
    for (const Vector3 eye : {Vector3{1, -2, -3}, {4, 1, -8}, {-3, 0, -40}}) {
        const Point wanted = times(shifted, {eye.x - offset, eye.y, eye.z, 1});
        const Point got = moved(eyeMove(seen, offset, focus), times(m, {eye.x, eye.y, eye.z, 1}));
        for (size_t k = 0; k < 4; ++k) EXPECT_NEAR(got[k], wanted[k], 1e-12) << eye.z;
    }
}

// Upside down, as programs draw into framebuffer objects that they show flipped.
TEST_F(ClipTransformTest, keepsMirroredProjectionsMirrored) {
    double m[16];
    std::ranges::copy(Projection{-2, 2, -1, 1, 1.5, 60}.matrix(), m);
    m[5] = -m[5];
    const ProjectionDetector seen = seenProjection(m);
    EXPECT_DOUBLE_EQ(seen.scaleX, 0.75);
    EXPECT_DOUBLE_EQ(seen.scaleY, -1.5);
}

} // namespace
} // namespace mural
