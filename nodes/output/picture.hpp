// Finished pictures as the outputs take them: rows bottom first as in OpenGL, tightly packed, 4
// bytes per pixel B G R A. A carries nothing and is never compared or shown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/pixel_viewport.hpp"

namespace mural {

constexpr size_t kPictureBytesPerPixel = 4;

// A view of somebody else's pixels.
struct Picture {
    int width = 0;
    int height = 0;
    const std::byte* bgra = nullptr; // [y][x][b g r a8], origin lower left

    [[nodiscard]] bool empty() const { return width <= 0 || height <= 0 || bgra == nullptr; }
    [[nodiscard]] size_t rowBytes() const {
        return static_cast<size_t>(width) * kPictureBytesPerPixel;
    }
    [[nodiscard]] size_t sizeBytes() const { return rowBytes() * static_cast<size_t>(height); }
    [[nodiscard]] const std::byte* row(int y) const {
        return bgra + rowBytes() * static_cast<size_t>(y);
    }
};

class OwnedPicture {
public:
    OwnedPicture() = default;
    OwnedPicture(int width, int height) { resize(width, height); }
    explicit OwnedPicture(const Picture& source) { assign(source); }

    // Contents are unspecified afterwards when the size changes. Memory is kept for the next use.
    void resize(int width, int height);
    void assign(const Picture& source);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] size_t rowBytes() const {
        return static_cast<size_t>(width_) * kPictureBytesPerPixel;
    }
    std::byte* row(int y) { return bytes_.data() + rowBytes() * static_cast<size_t>(y); }
    std::byte* data() { return bytes_.data(); }
    [[nodiscard]] Picture view() const { return {width_, height_, bytes_.data()}; }

private:
    int width_ = 0;
    int height_ = 0;
    std::vector<std::byte> bytes_;
};

// Copies all of `source` with its lower left corner at (x, y) of `target`; what lies outside is
// dropped.
void copyInto(OwnedPicture& target, int x, int y, const Picture& source);

// The part of `source` inside `rectangle`; pixels of the rectangle outside of `source` are black.
OwnedPicture cutOut(const Picture& source, const PixelViewport& rectangle);

// Lowest row becomes the topmost one.
void flipRows(OwnedPicture& picture);

struct PictureDifference {
    bool sizesDiffer = false;     // then nothing else is compared
    int64_t differingPixels = 0;  // with any difference in B, G or R
    int largestDifference = 0;    // of one channel, 0 to 255
    int firstX = -1, firstY = -1; // lowest row first, then from the left; -1 when there is none

    [[nodiscard]] bool same() const { return !sizesDiffer && differingPixels == 0; }
};

PictureDifference comparePictures(const Picture& expected, const Picture& actual);

// One line for people, e.g. "12 of 307200 pixels differ, by at most 3, first at x 10, y 20".
std::string
describe(const PictureDifference& difference, const Picture& expected, const Picture& actual);

} // namespace mural
