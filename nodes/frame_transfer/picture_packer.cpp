#include "nodes/frame_transfer/picture_packer.hpp"

#include "nodes/frame_transfer/bgra_swizzle.hpp"

namespace mural {

PicturePacker::PicturePacker(const std::string& codec, PictureAlpha alpha)
    : codec_(codec), asColours_(mayLose(codec)), alpha_(alpha) {}

Result<std::span<const std::byte>> PicturePacker::pack(uint32_t client, uint32_t window, int32_t width, int32_t height,
                                                       const std::byte* bgra) {
    const compositor::PlaneShape shape{compositor::PlaneFormat::Rgba8, width, height};
    const std::byte* pixels = bgra;
    if (asColours_) {
        rgba_.resize(shape.sizeBytes());
        swapRedAndBlue(bgra, rgba_.data(), rgba_.size() / 4, alpha_ == PictureAlpha::Dropped ? 0xff000000 : 0);
        pixels = rgba_.data();
    }
    compositor::TileDeltaEncoder& tiles = windows_[{client, window}];
    const size_t maximum = tiles.boundBytes(shape, codec_);
    if (packed_.size() < maximum) packed_.resize(maximum);
    auto size =
        tiles.encode({shape.format, width, height, static_cast<ptrdiff_t>(shape.rowBytes()), pixels}, codec_, packed_);
    if (!size) return size.error();
    rawBytes_ += shape.sizeBytes();
    packedBytes_ += *size;
    return std::span<const std::byte>(packed_).first(*size);
}

void PicturePacker::clientGone(uint32_t client) {
    std::erase_if(windows_, [&](const auto& w) { return w.first.first == client; });
}

} // namespace mural
