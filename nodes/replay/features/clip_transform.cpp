#include "nodes/replay/features/clip_transform.hpp"

namespace mural {

namespace {

using MatrixRow = std::array<double, 4>; // coefficients of x, y, w and 1

MatrixRow operator*(double by, const MatrixRow& a) { return {by * a[0], by * a[1], by * a[2], by * a[3]}; }
MatrixRow operator+(const MatrixRow& a, const MatrixRow& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
}

} // namespace

ClipTransform eyeMove(const ProjectionDetector& seen, double offset, double focusDistance) {
    const double k = seen.scaleX * offset;
    ClipTransform move;
    move.x = {0, 0, k / focusDistance, -k};
    return move;
}

ClipTransform screenMove(const ProjectionDetector& seen, const ScreenView& s) {
    // From clip coordinates back to the program's eye coordinates.
    const MatrixRow own[4] = {{1 / seen.scaleX, 0, -seen.shearX / seen.scaleX, 0},
                              {0, 1 / seen.scaleY, -seen.shearY / seen.scaleY, 0},
                              {0, 0, -1, 0},
                              {0, 0, 0, 1}};
    MatrixRow eye[3];
    for (size_t i = 0; i < 3; ++i) {
        const auto& m = s.fromProgram.m[i];
        eye[i] = m[0] * own[0] + m[1] * own[1] + m[2] * own[2] + m[3] * own[3];
    }
    const MatrixRow w = -1 * eye[2];
    // The screen's projection, mapped to its place on the wall.
    const MatrixRow x = 2 / (s.right - s.left) * eye[0] + (s.right + s.left) / (s.right - s.left) * eye[2];
    const MatrixRow y = 2 / (s.top - s.bottom) * eye[1] + (s.top + s.bottom) / (s.top - s.bottom) * eye[2];
    ClipTransform move;
    move.x = s.area.w * x + (2 * s.area.x + s.area.w - 1) * w + MatrixRow{-1, 0, 0, 0};
    move.y = s.area.h * y + (2 * s.area.y + s.area.h - 1) * w + MatrixRow{0, -1, 0, 0};
    move.w = w + MatrixRow{0, 0, -1, 0};
    move.z = seen.depth;
    return move;
}

void ClipTransform::apply(double (&m)[16], double unit) const {
    for (size_t column = 0; column < 4; ++column) {
        double* at = m + 4 * column;
        const double one = column == 3 ? unit : 0;
        const auto added = [&](const MatrixRow& by) {
            return by[0] * at[0] + by[1] * at[1] + by[2] * at[3] + by[3] * one;
        };
        const double dx = added(x), dy = added(y), dw = added(w);
        at[0] += dx;
        at[1] += dy;
        at[2] += z * dw;
        at[3] += dw;
    }
}

} // namespace mural
