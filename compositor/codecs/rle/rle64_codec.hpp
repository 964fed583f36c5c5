// Run lengths of 64 bits, two pixels at a time: the fastest of the three that parallel rendering has long used, here to be
// measured against. Records of a 4-byte head: bit 31 says that one word follows, repeated; otherwise as many follow as the
// rest of the head counts. A last half word of a row's end is completed by zeros.
#pragma once

#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

class Rle64Codec : public Codec {
public:
    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override;
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override;
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override;
};

} // namespace mural::compositor
