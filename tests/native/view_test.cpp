#include "native/runtime/view.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "nodes/player/pixel_mapping.hpp"

namespace mural::native {
namespace {

constexpr double kTolerance = 1e-12;

struct Projected {
    double x, y, depth; // normalised device coordinates
};
Projected project(const ViewInput& view, const Vector3& room) {
    const Matrix4 m = projectionOf(view) * toEyeOf(view);
    const auto row = [&](size_t r) { return m.m[r][0] * room.x + m.m[r][1] * room.y + m.m[r][2] * room.z + m.m[r][3]; };
    return {row(0) / row(3), row(1) / row(3), row(2) / row(3)};
}

ViewInput wallOf(int width, int height) {
    ViewInput view;
    view.width = width;
    view.height = height;
    return view;
}

TEST(View, mapsTheCornersOfAFlatWallToTheCornersOfThePicture) {
    const ViewInput view = wallOf(1600, 900);
    const double top = kWallHeight / 2, right = top * 1600 / 900;
    const Projected corner = project(view, {right, top, -1});
    EXPECT_NEAR(corner.x, 1, kTolerance);
    EXPECT_NEAR(corner.y, 1, kTolerance);
    const Projected opposite = project(view, {-right, -top, -1});
    EXPECT_NEAR(opposite.x, -1, kTolerance);
    EXPECT_NEAR(opposite.y, -1, kTolerance);
}

TEST(View, keepsPointsOfTheWallWhereverTheHeadIs) {
    ViewInput view = wallOf(800, 600);
    const Vector3 point{0.1, -0.05, -1};
    const Projected before = project(view, point);
    view.head = Matrix4::translation({0.3, 0.2, 0.5});
    const Projected after = project(view, point);
    EXPECT_NEAR(after.x, before.x, kTolerance);
    EXPECT_NEAR(after.y, before.y, kTolerance);
    EXPECT_LT(std::abs(project(view, {0.1, -0.05, -3}).x - before.x), 2);
}

TEST(View, separatesTheEyesInFrontOfAndBehindTheWall) {
    ViewInput left = wallOf(800, 600);
    left.eyeBase = 0.06;
    left.pass.eye = Eye::Left;
    ViewInput right = left;
    right.pass.eye = Eye::Right;
    EXPECT_GT(project(left, {0, 0, -0.5}).x, project(right, {0, 0, -0.5}).x); // nearer than the wall: crossed
    EXPECT_NEAR(project(left, {0, 0, -1}).x, project(right, {0, 0, -1}).x, kTolerance);
    EXPECT_LT(project(left, {0, 0, -2}).x, project(right, {0, 0, -2}).x);
}

TEST(View, mapsNearAndFarPlanes) {
    ViewInput view = wallOf(640, 480);
    view.nearPlane = 0.5;
    view.farPlane = 20;
    EXPECT_NEAR(project(view, {0, 0, -0.5}).depth, -1, kTolerance);
    EXPECT_NEAR(project(view, {0, 0, -20}).depth, 1, kTolerance);
}

// A pass draws pixel i of its picture where the window has position windowAt.
void expectPixelCentres(const ViewInput& view, const ViewInput& whole) {
    const PixelViewport drawn = inPass(view.pass, {0, 0, view.width, view.height});
    const Vector3 point{0.07, 0.03, -1.5};
    const Projected inWindow = project(whole, point), inPassPicture = project(view, point);
    const auto place = placeInPass(view.pass, (inWindow.x + 1) / 2 * whole.width, (inWindow.y + 1) / 2 * whole.height);
    EXPECT_NEAR((inPassPicture.x + 1) / 2 * drawn.w, place[0], 1e-9);
    EXPECT_NEAR((inPassPicture.y + 1) / 2 * drawn.h, place[1], 1e-9);
}

TEST(View, drawsEveryNthPixelOfAKernel) {
    const ViewInput whole = wallOf(801, 603); // sizes that the kernel does not divide
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 2; ++y) {
            ViewInput view = whole;
            view.pass.kernelX = x;
            view.pass.kernelY = y;
            view.pass.kernelWidth = 3;
            view.pass.kernelHeight = 2;
            expectPixelCentres(view, whole);
        }
}

TEST(View, movesSamplesAndScalesZooms) {
    const ViewInput whole = wallOf(800, 600);
    ViewInput sampled = whole;
    sampled.pass.sample = 1;
    sampled.pass.samples = 4;
    expectPixelCentres(sampled, whole);
    ViewInput zoomed = whole;
    zoomed.pass.zoom = {0.5, 0.25};
    expectPixelCentres(zoomed, whole);
}

TEST(View, extendsAScreenToTheWholePicture) {
    // Two screens side by side in one plane show what a wide screen shows.
    ScreenView wide;
    wide.left = -2;
    wide.right = 2;
    ViewInput whole = wallOf(800, 400);
    whole.screen = wide;
    ScreenView rightHalf = wide;
    rightHalf.area = {0.5, 0, 0.5, 1};
    rightHalf.left = 0;
    ViewInput view = whole;
    view.screen = rightHalf;
    const Vector3 point{0.7, 0.2, -1.3};
    EXPECT_NEAR(project(view, point).x, project(whole, point).x, kTolerance);
    EXPECT_NEAR(project(view, point).y, project(whole, point).y, kTolerance);
}

TEST(View, cullsByTheFrustumOfTheArea) {
    const ViewInput view = wallOf(800, 600);
    const Frustum all = frustumOf(view, {0, 0, 800, 600}), left = frustumOf(view, {0, 0, 400, 600});
    EXPECT_NEAR(left.left, all.left, kTolerance);
    EXPECT_NEAR(left.right, (all.left + all.right) / 2, kTolerance);
    EXPECT_NEAR(left.top, all.top, kTolerance);
}

} // namespace
} // namespace mural::native
