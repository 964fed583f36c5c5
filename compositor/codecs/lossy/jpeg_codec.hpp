// JPEG by libjpeg-turbo, with lossless alpha. RGBA8 only.
#pragma once

#include "compositor/codecs/lossy/alpha_plane.hpp"

namespace mural::compositor {

class JpegCodec : public Codec {
public:
    // quality: 1 to 100. halfColour: 4:2:0 chroma subsampling.
    JpegCodec(int quality, bool halfColour);
    ~JpegCodec() override;
    JpegCodec(const JpegCodec&) = delete;
    JpegCodec& operator=(const JpegCodec&) = delete;

    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override;
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override;
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override;

private:
    int quality_;
    int subsampling_;
    void* compressor_;
    void* decompressor_;
    AlphaPlane alpha_;
};

} // namespace mural::compositor
