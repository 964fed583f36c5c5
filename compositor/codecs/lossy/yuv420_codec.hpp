// Luma per pixel, chroma per 2 x 2 pixels (full-range BT.601, 8 bits), lossless alpha: always 1.5 bytes per pixel. The
// error is largest where colours change from pixel to pixel, as at lines. RGBA8 only.
#pragma once

#include "compositor/codecs/lossy/alpha_plane.hpp"

namespace mural::compositor {

class Yuv420Codec : public Codec {
public:
    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override;
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override;
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override;

private:
    AlphaPlane alpha_;
};

} // namespace mural::compositor
