#include "nodes/output/eye_pair.hpp"

#include <algorithm>
#include <cstring>

namespace mural {

namespace {

void halveInto(OwnedPicture& into, const Picture& eye, int x0, int y0, int width, int height, bool columns) {
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int ax = columns ? 2 * x : x, ay = columns ? y : 2 * y;
            const int bx = std::min(columns ? ax + 1 : ax, eye.width - 1),
                      by = std::min(columns ? ay : ay + 1, eye.height - 1);
            const std::byte* a = eye.row(ay) + static_cast<size_t>(ax) * kPictureBytesPerPixel;
            const std::byte* b = eye.row(by) + static_cast<size_t>(bx) * kPictureBytesPerPixel;
            std::byte* to = into.row(y0 + y) + static_cast<size_t>(x0 + x) * kPictureBytesPerPixel;
            for (size_t i = 0; i < kPictureBytesPerPixel; ++i)
                to[i] = static_cast<std::byte>((std::to_integer<int>(a[i]) + std::to_integer<int>(b[i]) + 1) / 2);
        }
    }
}

} // namespace

void stackEyes(const EyePair& eyes, OwnedPicture& into) {
    into.resize(eyes.left.width, 2 * eyes.left.height);
    if (into.view().empty()) return;
    std::memcpy(into.row(0), eyes.right.bgra, eyes.right.sizeBytes());
    std::memcpy(into.row(eyes.left.height), eyes.left.bgra, eyes.left.sizeBytes());
}

EyePair eyesOfStack(const Picture& stacked) {
    const int height = stacked.height / 2;
    return {{stacked.width, height, stacked.row(height)}, {stacked.width, height, stacked.bgra}};
}

void sideBySide(const EyePair& eyes, OwnedPicture& into) {
    const Picture& left = eyes.left;
    into.resize(left.width, left.height);
    const int half = (left.width + 1) / 2;
    halveInto(into, left, 0, 0, half, left.height, true);
    halveInto(into, eyes.right, half, 0, left.width - half, left.height, true);
}

void topBottom(const EyePair& eyes, OwnedPicture& into) {
    const Picture& left = eyes.left;
    into.resize(left.width, left.height);
    const int half = (left.height + 1) / 2;
    halveInto(into, eyes.right, 0, 0, left.width, left.height - half, false);
    halveInto(into, left, 0, left.height - half, left.width, half, false);
}

} // namespace mural
