// Run lengths of 64 bits, two pixels at a time: the fastest of the three classic codecs of parallel rendering, for
// comparisons. A record has a head of 4 bytes: bit 31 announces one repeated word; otherwise the rest of the head
// counts literal words. Zeros complete a last half word of a row.
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
