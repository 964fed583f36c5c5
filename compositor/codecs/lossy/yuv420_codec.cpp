#include "compositor/codecs/lossy/yuv420_codec.hpp"

#include <algorithm>

namespace mural::compositor {

namespace {

// Weights in 1/65536. The rows of the first two matrices sum to whole numbers, so greys stay grey.
constexpr int kHalf = 32768;
int brightness(int r, int g, int b) { return (19595 * r + 38470 * g + 7471 * b + kHalf) >> 16; }
int blueness(int r, int g, int b) {
    return std::clamp(((-11059 * r - 21709 * g + 32768 * b + kHalf) >> 16) + 128, 0, 255);
}
int redness(int r, int g, int b) {
    return std::clamp(((32768 * r - 27439 * g - 5329 * b + kHalf) >> 16) + 128, 0, 255);
}

std::byte clamped(int value) { return static_cast<std::byte>(std::clamp(value, 0, 255)); }
int at(const std::byte* bytes, size_t i) { return std::to_integer<int>(bytes[i]); }

struct Layout {
    explicit Layout(const PlaneShape& s)
        : width(static_cast<size_t>(s.width)),
          height(static_cast<size_t>(s.height)),
          halfWidth((width + 1) / 2),
          halfHeight((height + 1) / 2) {}
    [[nodiscard]] size_t sizeBytes() const { return width * height + 2 * halfWidth * halfHeight; }
    size_t width, height, halfWidth, halfHeight;
};

} // namespace

size_t Yuv420Codec::boundBytes(const PlaneShape& shape) const {
    return shape.width <= 0 || shape.height <= 0 ? 0 : Layout(shape).sizeBytes() + alpha_.boundBytes(shape);
}

Result<size_t> Yuv420Codec::encode(const PlaneView& plane, std::span<std::byte> into) {
    if (plane.empty()) return size_t{0};
    const Layout l(shapeOf(plane));
    std::byte* y = into.data();
    std::byte* u = y + l.width * l.height;
    std::byte* v = u + l.halfWidth * l.halfHeight;
    for (size_t row = 0; row < l.height; row += 2) {
        const std::byte* rows[2] = {plane.row(static_cast<int32_t>(row)),
                                    plane.row(static_cast<int32_t>(std::min(row + 1, l.height - 1)))};
        for (size_t half = 0; half < std::min<size_t>(2, l.height - row); ++half)
            for (size_t x = 0; x < l.width; ++x)
                y[(row + half) * l.width + x] = static_cast<std::byte>(
                    brightness(at(rows[half], 4 * x), at(rows[half], 4 * x + 1), at(rows[half], 4 * x + 2)));
        for (size_t x = 0; x < l.halfWidth; ++x) {
            const size_t left = 8 * x, right = 4 * std::min(2 * x + 1, l.width - 1); // an odd last column counts twice
            int sum[3];
            for (size_t c = 0; c < 3; ++c)
                sum[c] = (at(rows[0], left + c) + at(rows[0], right + c) + at(rows[1], left + c) +
                          at(rows[1], right + c) + 2) >>
                         2;
            *u++ = static_cast<std::byte>(blueness(sum[0], sum[1], sum[2]));
            *v++ = static_cast<std::byte>(redness(sum[0], sum[1], sum[2]));
        }
    }
    const size_t alpha = alpha_.encode(plane, into.subspan(l.sizeBytes()));
    if (alpha == 0)
        return Error{"codec yuv420: no memory for the alpha of a plane of " + std::to_string(plane.width) + "x" +
                     std::to_string(plane.height) + "; use smaller pictures"};
    return l.sizeBytes() + alpha;
}

Result<void> Yuv420Codec::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    const auto damaged = [&](const char* what) { return damagedPlane("yuv420", into, bytes.size(), what); };
    if (into.empty()) return bytes.empty() ? Result<void>() : damaged("an empty plane has no bytes");
    if (into.format != PlaneFormat::Rgba8) return damaged("only RGBA8 is supported");
    const Layout l(shapeOf(into));
    if (bytes.size() < l.sizeBytes()) return damaged("it is truncated");
    const std::byte* y = bytes.data();
    const std::byte* u = y + l.width * l.height;
    const std::byte* v = u + l.halfWidth * l.halfHeight;
    for (size_t row = 0; row < l.height; ++row) {
        std::byte* to = into.row(static_cast<int32_t>(row));
        const size_t halfRow = row / 2 * l.halfWidth;
        for (size_t x = 0; x < l.width; ++x, to += 4) {
            const int bright = at(y, row * l.width + x), blue = at(u, halfRow + x / 2) - 128,
                      red = at(v, halfRow + x / 2) - 128;
            to[0] = clamped(bright + ((91881 * red + kHalf) >> 16));
            to[1] = clamped(bright - ((22554 * blue + 46802 * red + kHalf) >> 16));
            to[2] = clamped(bright + ((116130 * blue + kHalf) >> 16));
        }
    }
    const size_t alpha = alpha_.decode(bytes.subspan(l.sizeBytes()), into);
    return alpha != 0 && l.sizeBytes() + alpha == bytes.size() ? Result<void>() : damaged("its alpha is invalid");
}

} // namespace mural::compositor
