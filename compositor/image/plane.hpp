// Pixels in memory: non-owning views, and the owning Plane. Row 0 is the lowest one, as in OpenGL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/geometry/pixel_viewport.hpp"
#include "compositor/image/pixel_bytes.hpp"
#include "compositor/image/plane_format.hpp"

namespace mural::compositor {

// Byte is std::byte or const std::byte. Rows have byte alignment.
template <class Byte> struct BasicPlaneView {
    PlaneFormat format = PlaneFormat::Rgba8;
    int32_t width = 0;
    int32_t height = 0;
    ptrdiff_t strideBytes = 0; // distance to the row above
    Byte* pixels = nullptr;

    [[nodiscard]] Byte* row(int32_t y) const { return pixels + y * strideBytes; }
    [[nodiscard]] size_t rowBytes() const { return static_cast<size_t>(width) * bytesPerPixel(format); }
    [[nodiscard]] size_t sizeBytes() const { return rowBytes() * static_cast<size_t>(height); }
    [[nodiscard]] bool empty() const { return width <= 0 || height <= 0; }
    // Returns a part. Requires `area` to lie inside.
    [[nodiscard]] BasicPlaneView part(const PixelViewport& area) const {
        return {format, area.w, area.h, strideBytes,
                row(area.y) + static_cast<ptrdiff_t>(static_cast<size_t>(area.x) * bytesPerPixel(format))};
    }
    operator BasicPlaneView<const std::byte>() const {
        return {format, width, height, strideBytes, pixels};
    } // NOLINT(google-explicit-constructor)
};
using PlaneView = BasicPlaneView<const std::byte>;
using MutablePlaneView = BasicPlaneView<std::byte>;

[[nodiscard]] inline bool sameShape(const PlaneView& a, const PlaneView& b) {
    return a.format == b.format && a.width == b.width && a.height == b.height;
}

// Rows are contiguous without padding.
class Plane {
public:
    Plane() = default;
    Plane(PlaneFormat format, int32_t width, int32_t height)
        : format_(format),
          width_(width),
          height_(height),
          pixels_(static_cast<size_t>(width) * static_cast<size_t>(height) * bytesPerPixel(format)) {}

    [[nodiscard]] MutablePlaneView view() { return {format_, width_, height_, stride(), pixels_.data()}; }
    [[nodiscard]] PlaneView view() const { return {format_, width_, height_, stride(), pixels_.data()}; }
    [[nodiscard]] PlaneFormat format() const { return format_; }
    [[nodiscard]] int32_t width() const { return width_; }
    [[nodiscard]] int32_t height() const { return height_; }
    [[nodiscard]] PixelBytes& bytes() { return pixels_; }
    [[nodiscard]] const PixelBytes& bytes() const { return pixels_; }
    friend bool operator==(const Plane&, const Plane&) = default;

private:
    [[nodiscard]] ptrdiff_t stride() const {
        return static_cast<ptrdiff_t>(static_cast<size_t>(width_) * bytesPerPixel(format_));
    }
    PlaneFormat format_ = PlaneFormat::Rgba8;
    int32_t width_ = 0;
    int32_t height_ = 0;
    PixelBytes pixels_;
};

// Requires equal shapes.
inline void copyPlane(const MutablePlaneView& to, const PlaneView& from) {
    for (int32_t y = 0; y < from.height; ++y) std::memcpy(to.row(y), from.row(y), from.rowBytes());
}

} // namespace mural::compositor
