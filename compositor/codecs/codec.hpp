// A way to write a plane as bytes and to read it back. Instances hold scratch memory: each is used by one thread at a time.
// Shape and codec of encoded bytes travel with them; the bytes themselves tell neither.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/result.hpp"
#include "compositor/image/plane.hpp"

namespace mural::compositor {

struct PlaneShape {
    PlaneFormat format = PlaneFormat::Rgba8;
    int32_t width = 0;
    int32_t height = 0;

    [[nodiscard]] size_t rowBytes() const { return static_cast<size_t>(width) * bytesPerPixel(format); }
    [[nodiscard]] size_t sizeBytes() const { return rowBytes() * static_cast<size_t>(height); }
};
[[nodiscard]] inline PlaneShape shapeOf(const PlaneView& p) { return {p.format, p.width, p.height}; }

struct CodecInfo {
    std::string name;
    bool lossless = true; // a lossy one is only ever taken by name
    uint32_t formats = 0; // a bit 1 << PlaneFormat for each that it takes

    [[nodiscard]] bool takes(PlaneFormat f) const { return (formats >> static_cast<unsigned>(f) & 1) != 0; }
};
constexpr uint32_t formatBit(PlaneFormat f) { return 1u << static_cast<unsigned>(f); }
constexpr uint32_t kAllFormats = (1u << kPlaneFormats) - 1;

class Codec {
public:
    virtual ~Codec() = default;

    // As many bytes as encode may ever need room for.
    [[nodiscard]] virtual size_t boundBytes(const PlaneShape& shape) const = 0;
    // `into` has boundBytes. Returns how many were written. The plane's format is one that the codec takes.
    [[nodiscard]] virtual Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) = 0;
    // The plane has the shape of the one that was encoded. Any bytes may come in: what is no encoded plane of this shape is an
    // error, and then the plane holds anything. No byte outside of both is touched.
    [[nodiscard]] virtual Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) = 0;
};

// One line for bytes that are no such plane.
[[nodiscard]] Error damagedPlane(const std::string& codec, const PlaneView& shape, size_t sizeBytes, const char* what);

} // namespace mural::compositor
