// A codec encodes planes as bytes and decodes them. Instances own scratch memory: one thread at a time. Shape and codec
// travel separately; the encoded bytes contain neither.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/base/result.hpp"
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
    bool lossless = true; // lossy codecs are only selected by name
    uint32_t formats = 0; // bit 1 << PlaneFormat per supported format

    [[nodiscard]] bool takes(PlaneFormat f) const { return (formats >> static_cast<unsigned>(f) & 1) != 0; }
};
constexpr uint32_t formatBit(PlaneFormat f) { return 1u << static_cast<unsigned>(f); }
constexpr uint32_t kAllFormats = (1u << kPlaneFormats) - 1;

class Codec {
public:
    virtual ~Codec() = default;

    // Returns the largest encoded size.
    [[nodiscard]] virtual size_t boundBytes(const PlaneShape& shape) const = 0;
    // Encodes; returns the number of bytes. Requires boundBytes() in `into` and a supported format.
    [[nodiscard]] virtual Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) = 0;
    // Decodes into a plane of the encoded shape. Input is untrusted: malformed bytes are an error, after which the
    // plane's contents are unspecified. Never accesses memory outside of both arguments.
    [[nodiscard]] virtual Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) = 0;
};

// Returns the error for malformed bytes, one line.
[[nodiscard]] Error damagedPlane(const std::string& codec, const PlaneView& shape, size_t sizeBytes, const char* what);

} // namespace mural::compositor
