// Uncompressed rows: for links faster than any codec, and as the baseline of measurements.
#pragma once

#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

class RawCodec : public Codec {
public:
    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override {
        return shape.width > 0 && shape.height > 0 ? shape.sizeBytes() : 0;
    }
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override {
        if (plane.empty()) return size_t{0};
        copyPlane({plane.format, plane.width, plane.height, static_cast<ptrdiff_t>(plane.rowBytes()), into.data()},
                  plane);
        return plane.sizeBytes();
    }
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override {
        if (bytes.size() != (into.empty() ? 0 : into.sizeBytes()))
            return damagedPlane("raw", into, bytes.size(), "a raw plane has the size of its rows");
        if (!into.empty())
            copyPlane(into,
                      {into.format, into.width, into.height, static_cast<ptrdiff_t>(into.rowBytes()), bytes.data()});
        return {};
    }
};

} // namespace mural::compositor
