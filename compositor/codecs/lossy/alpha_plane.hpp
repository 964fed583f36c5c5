// The alpha of an RGBA8 plane, which lossy codecs keep exactly: one byte when it is the same everywhere, or LZ4.
#pragma once

#include <vector>

#include "compositor/codecs/codec.hpp"
#include "compositor/codecs/general/byte_compressor.hpp"

namespace mural::compositor {

class AlphaPlane {
public:
    AlphaPlane() : compressor_(makeLz4()) {}
    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const;
    // Returns the bytes written; 0 when there is no memory.
    [[nodiscard]] size_t encode(const PlaneView& plane, std::span<std::byte> into);
    // Puts it into the plane and returns the bytes it took; 0 for what is no alpha plane.
    [[nodiscard]] size_t decode(std::span<const std::byte> bytes, const MutablePlaneView& into);

private:
    std::unique_ptr<ByteCompressor> compressor_;
    std::vector<std::byte> scratch_;
};

} // namespace mural::compositor
