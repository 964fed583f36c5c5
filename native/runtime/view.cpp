#include "native/runtime/view.hpp"

#include <cmath>

#include "nodes/player/pixel_mapping.hpp"

namespace mural::native {

namespace {

// Edges of the whole picture on the plane at distance 1 from the eye.
struct Edges {
    double left, right, bottom, top;
};

double eyeOffset(const ViewInput& view) {
    if (view.pass.eye == Eye::Cyclop) return 0;
    return (view.pass.eye == Eye::Left ? -0.5 : 0.5) * view.eyeBase;
}

// Position of the eye in the room, for a flat wall.
Vector3 eyeAt(const ViewInput& view) { return transformPoint(view.head, {eyeOffset(view), 0, 0}); }

Edges wallEdges(const ViewInput& view) {
    constexpr double kNearest = 1e-3; // an eye in the wall, or behind it, sees the wall from here
    const double halfHeight = kWallHeight / 2 * view.wallDistance;
    const double halfWidth = halfHeight * view.width / view.height;
    const Vector3 eye = eyeAt(view);
    const double distance = std::max(eye.z + view.wallDistance, kNearest * view.wallDistance);
    return {(-halfWidth - eye.x) / distance, (halfWidth - eye.x) / distance, (-halfHeight - eye.y) / distance,
            (halfHeight - eye.y) / distance};
}

// The screen shows `area` of the picture. Extends its edges to the whole picture.
Edges screenEdges(const ScreenView& s) {
    const double width = (s.right - s.left) / s.area.w, height = (s.top - s.bottom) / s.area.h;
    const double left = s.left - s.area.x * width, bottom = s.bottom - s.area.y * height;
    return {left, left + width, bottom, bottom + height};
}

Edges edgesOf(const ViewInput& view) { return view.screen ? screenEdges(*view.screen) : wallEdges(view); }

// The edges of pixels [from, from + size) of the pass's picture, of which the window's pixel positions [0, window] are
// edges [low, high]. `scale` and `origin` map positions of the window to positions of the pass.
struct Span {
    double low, high;
};
Span spanOf(double low, double high, double window, double scale, double origin, double from, double size) {
    const auto at = [&](double pixel) { return low + (pixel - origin) / scale / window * (high - low); };
    return {at(from), at(from + size)};
}

// The edges of an area of the pass's picture.
Edges edgesOf(const ViewInput& view, const PixelViewport& area) {
    const Edges all = edgesOf(view);
    const auto zero = placeInPass(view.pass, 0, 0);
    const auto [left, right] =
        spanOf(all.left, all.right, view.width, view.pass.zoom.x / view.pass.kernelWidth, zero[0], area.x, area.w);
    const auto [bottom, top] =
        spanOf(all.bottom, all.top, view.height, view.pass.zoom.y / view.pass.kernelHeight, zero[1], area.y, area.h);
    return {left, right, bottom, top};
}

} // namespace

Frustum frustumOf(const ViewInput& view, const PixelViewport& area) {
    const Edges e = edgesOf(view, area);
    const double n = view.nearPlane;
    return {e.left * n, e.right * n, e.bottom * n, e.top * n, n, view.farPlane};
}

Matrix4 projectionOf(const ViewInput& view) {
    const Frustum f = frustumOf(view, inPass(view.pass, {0, 0, view.width, view.height}));
    Matrix4 p;
    p.m = {{{2 * f.nearPlane / f.width(), 0, (f.right + f.left) / f.width(), 0},
            {0, 2 * f.nearPlane / f.height(), (f.top + f.bottom) / f.height(), 0},
            {0, 0, -(f.farPlane + f.nearPlane) / (f.farPlane - f.nearPlane),
             -2 * f.farPlane * f.nearPlane / (f.farPlane - f.nearPlane)},
            {0, 0, -1, 0}}};
    return p;
}

Matrix4 toEyeOf(const ViewInput& view) {
    if (view.screen) return view.screen->fromProgram * rigidInverse(view.head);
    const Vector3 eye = eyeAt(view);
    return Matrix4::translation({-eye.x, -eye.y, -eye.z});
}

} // namespace mural::native
