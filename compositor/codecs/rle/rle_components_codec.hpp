// Run lengths of bytes, one stream per byte of a word, for comparisons. Swizzled: each stream takes two bits of each
// byte, high bits first, so noise in low bits does not break runs of high bits. A stream is its size and its bytes; a
// marker precedes a value and its repetition count (1 to 255).
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

// Stream s takes bits 7-2s and 6-2s of each byte. Self-inverse.
[[nodiscard]] uint32_t swizzledWord(uint32_t word);

} // namespace mural::compositor
