#include "nodes/output/picture.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

namespace mural {

void OwnedPicture::resize(int width, int height, PictureFormat format) {
    format_ = format;
    width_ = std::max(width, 0);
    height_ = std::max(height, 0);
    bytes_.resize(rowBytes() * static_cast<size_t>(height_));
}

void OwnedPicture::assign(const Picture& source) {
    if (source.empty()) {
        resize(0, 0);
        return;
    }
    resize(source.width, source.height, source.format);
    std::memcpy(bytes_.data(), source.bgra, source.sizeBytes());
}

namespace {

constexpr uint32_t scaled(uint32_t value, uint32_t largest, uint32_t newLargest) {
    return (2 * value * newLargest + largest) / (2 * largest);
}

constexpr uint32_t toEightBits(uint32_t pixel) {
    const auto channel = [&](int shift) { return scaled(pixel >> shift & 1023, 1023, 255); };
    return channel(0) | channel(10) << 8 | channel(20) << 16 | scaled(pixel >> 30, 3, 255) << 24;
}

constexpr uint32_t toTenBits(uint32_t pixel) {
    const auto channel = [&](int shift) { return scaled(pixel >> shift & 255, 255, 1023); };
    return channel(0) | channel(8) << 10 | channel(16) << 20 | scaled(pixel >> 24, 255, 3) << 30;
}

} // namespace

void convertPixels(PictureFormat fromFormat, const std::byte* from, PictureFormat toFormat, std::byte* to,
                   size_t pixels) {
    if (fromFormat == toFormat) {
        std::memcpy(to, from, pixels * kPictureBytesPerPixel);
        return;
    }
    const bool widens = toFormat == PictureFormat::Bgr10A2;
    for (size_t i = 0; i < pixels; ++i) {
        uint32_t pixel = 0;
        std::memcpy(&pixel, from + i * kPictureBytesPerPixel, sizeof pixel);
        pixel = widens ? toTenBits(pixel) : toEightBits(pixel);
        std::memcpy(to + i * kPictureBytesPerPixel, &pixel, sizeof pixel);
    }
}

void copyInto(OwnedPicture& target, int x, int y, const Picture& source) {
    if (source.empty()) return;
    const PixelViewport part = intersect({x, y, source.width, source.height}, {0, 0, target.width(), target.height()});
    if (part.empty()) return;
    const size_t targetSkip = static_cast<size_t>(part.x) * kPictureBytesPerPixel;
    const size_t sourceSkip = static_cast<size_t>(part.x - x) * kPictureBytesPerPixel;
    for (int line = part.y; line < part.top(); ++line)
        convertPixels(source.format, source.row(line - y) + sourceSkip, target.format(), target.row(line) + targetSkip,
                      static_cast<size_t>(part.w));
}

OwnedPicture cutOut(const Picture& source, const PixelViewport& rectangle) {
    OwnedPicture part;
    part.resize(rectangle.w, rectangle.h, source.format);
    copyInto(part, -rectangle.x, -rectangle.y, source);
    return part;
}

void flipRows(OwnedPicture& picture) {
    for (int low = 0, high = picture.height() - 1; low < high; ++low, --high)
        std::swap_ranges(picture.row(low), picture.row(low) + picture.rowBytes(), picture.row(high));
}

namespace {

uint32_t colourAt(const std::byte* row, int x) {
    uint32_t pixel = 0;
    std::memcpy(&pixel, row + static_cast<size_t>(x) * kPictureBytesPerPixel, sizeof pixel);
    return pixel & 0x00ffffffU;
}

// The value of one channel is at the same place in both words, so byte order does not matter.
int largestChannelDifference(uint32_t a, uint32_t b) {
    int largest = 0;
    for (int shift = 0; shift < 24; shift += 8)
        largest =
            std::max(largest, std::abs(static_cast<int>(a >> shift & 0xffU) - static_cast<int>(b >> shift & 0xffU)));
    return largest;
}

// Most rows of most comparisons are equal: one pass without branches that the compiler vectorises.
bool sameColours(const std::byte* a, const std::byte* b, int width) {
    uint32_t difference = 0;
    for (int x = 0; x < width; ++x) difference |= colourAt(a, x) ^ colourAt(b, x);
    return difference == 0;
}

} // namespace

PictureDifference comparePictures(const Picture& expected, const Picture& actual) {
    PictureDifference result;
    result.sizesDiffer = expected.width != actual.width || expected.height != actual.height;
    if (result.sizesDiffer) return result;
    for (int y = 0; y < expected.height; ++y) {
        const std::byte* a = expected.row(y);
        const std::byte* b = actual.row(y);
        if (sameColours(a, b, expected.width)) continue;
        for (int x = 0; x < expected.width; ++x) {
            const int difference = largestChannelDifference(colourAt(a, x), colourAt(b, x));
            if (difference == 0) continue;
            if (result.differingPixels++ == 0) {
                result.firstX = x;
                result.firstY = y;
            }
            result.largestDifference = std::max(result.largestDifference, difference);
        }
    }
    return result;
}

std::string describe(const PictureDifference& difference, const Picture& expected, const Picture& actual) {
    if (difference.sizesDiffer)
        return fmt::format("sizes differ: {}x{} expected, {}x{} found", expected.width, expected.height, actual.width,
                           actual.height);
    const int64_t pixels = static_cast<int64_t>(expected.width) * expected.height;
    if (difference.differingPixels == 0) return fmt::format("0 of {} pixels differ", pixels);
    return fmt::format("{} of {} pixels differ, by at most {}, first at x {}, y {}", difference.differingPixels, pixels,
                       difference.largestDifference, difference.firstX, difference.firstY);
}

} // namespace mural
