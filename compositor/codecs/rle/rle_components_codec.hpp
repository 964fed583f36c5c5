// Run lengths of bytes, each of the four bytes of a word in a stream of its own, to be measured against. Swizzled: each stream
// gets two bits of each byte, the high ones first, so that what is noise in the low bits does not break the runs of the high.
// A stream: its size, then bytes; the marker announces a value and how often it comes (1 to 255).
#pragma once

#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

class RleComponentsCodec : public Codec {
public:
    explicit RleComponentsCodec(bool swizzled) : swizzled_(swizzled) {}

    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override;
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override;
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override;

private:
    bool swizzled_;
};

// Stream s gets bits 7-2s and 6-2s of each byte; its own inverse.
[[nodiscard]] uint32_t swizzledWord(uint32_t word);

} // namespace mural::compositor
