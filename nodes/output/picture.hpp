// Finished pictures for the outputs: bottom row first as in OpenGL, tightly packed, 4 bytes per pixel. Windows with an
// alpha channel show the alpha; all other outputs ignore it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/picture_format.hpp"
#include "common/geometry/pixel_viewport.hpp"

namespace mural {

constexpr size_t kPictureBytesPerPixel = 4;

// A view of pixels in memory that it does not own.
struct Picture {
    int width = 0;
    int height = 0;
    const std::byte* bgra = nullptr; // [y][x], 4 bytes each, origin lower left
    PictureFormat format = PictureFormat::Bgra8;

    [[nodiscard]] bool empty() const { return width <= 0 || height <= 0 || bgra == nullptr; }
    [[nodiscard]] size_t rowBytes() const { return static_cast<size_t>(width) * kPictureBytesPerPixel; }
    [[nodiscard]] size_t sizeBytes() const { return rowBytes() * static_cast<size_t>(height); }
    [[nodiscard]] const std::byte* row(int y) const { return bgra + rowBytes() * static_cast<size_t>(y); }
};

class OwnedPicture {
public:
    OwnedPicture() = default;
    OwnedPicture(int width, int height) { resize(width, height); }
    explicit OwnedPicture(const Picture& source) { assign(source); }

    // Leaves the contents unspecified if the size or the format changes. Keeps the memory for reuse.
    void resize(int width, int height, PictureFormat format = PictureFormat::Bgra8);
    void assign(const Picture& source);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] size_t rowBytes() const { return static_cast<size_t>(width_) * kPictureBytesPerPixel; }
    std::byte* row(int y) { return bytes_.data() + rowBytes() * static_cast<size_t>(y); }
    std::byte* data() { return bytes_.data(); }
    [[nodiscard]] PictureFormat format() const { return format_; }
    [[nodiscard]] Picture view() const { return {width_, height_, bytes_.data(), format_}; }

private:
    int width_ = 0;
    int height_ = 0;
    PictureFormat format_ = PictureFormat::Bgra8;
    std::vector<std::byte> bytes_;
};

// Converts pixels and rounds to the nearest value, as OpenGL does. The colours of 8 bits survive a conversion to 10
// bits and back; alpha keeps 2 bits.
void convertPixels(PictureFormat fromFormat, const std::byte* from, PictureFormat toFormat, std::byte* to,
                   size_t pixels);

// Copies all of `source` in the format of `target` with its lower left corner at (x, y) of `target`; pixels outside
// are dropped.
void copyInto(OwnedPicture& target, int x, int y, const Picture& source);

// Returns the part of `source` inside `rectangle`. Pixels of the rectangle outside of `source` are black.
OwnedPicture cutOut(const Picture& source, const PixelViewport& rectangle);

// Mirrors the picture vertically.
void flipRows(OwnedPicture& picture);

struct PictureDifference {
    bool sizesDiffer = false;     // true: the pixels are not compared
    int64_t differingPixels = 0;  // pixels with a difference in B, G or R
    int largestDifference = 0;    // in one channel, 0 to 255
    int firstX = -1, firstY = -1; // lowest row first, then from the left; -1: no difference

    [[nodiscard]] bool same() const { return !sizesDiffer && differingPixels == 0; }
};

// Requires Bgra8 pictures.
PictureDifference comparePictures(const Picture& expected, const Picture& actual);

// Returns a line such as "12 of 307200 pixels differ, by at most 3, first at x 10, y 20".
std::string describe(const PictureDifference& difference, const Picture& expected, const Picture& actual);

} // namespace mural
