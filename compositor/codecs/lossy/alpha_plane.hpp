// Lossless alpha of an RGBA8 plane for lossy codecs: one byte if it is uniform, otherwise LZ4.
#pragma once

#include <vector>

#include "compositor/codecs/codec.hpp"
#include "compositor/codecs/general/byte_compressor.hpp"

namespace mural::compositor {

class AlphaPlane {
public:
    AlphaPlane() : compressor_(makeLz4()) {}
    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const;
    // Returns the number of bytes written; 0 without memory.
    [[nodiscard]] size_t encode(const PlaneView& plane, std::span<std::byte> into);
    // Writes alpha into the plane and returns the number of bytes read; 0 for malformed data.
    [[nodiscard]] size_t decode(std::span<const std::byte> bytes, const MutablePlaneView& into);

private:
    std::unique_ptr<ByteCompressor> compressor_;
    std::vector<std::byte> scratch_;
};

} // namespace mural::compositor
