#include "nodes/frame_transfer/picture_unpacker.hpp"

#include <cstring>

#include "nodes/frame_transfer/bgra_swizzle.hpp"

namespace mural {

PictureUnpacker::PictureUnpacker(const std::string& codec) : codec_(codec), asColours_(mayLose(codec)) {}

Result<void> PictureUnpacker::unpack(uint32_t client, uint32_t window, int32_t width, int32_t height,
                                     std::span<const std::byte> packed, std::span<std::byte> into) {
    const compositor::PlaneShape shape{compositor::PlaneFormat::Rgba8, width, height};
    if (width <= 0 || height <= 0 || into.size() != shape.sizeBytes())
        return Error{"an encoded picture of invalid size"};
    Window& w = windows_[{client, window}];
    if (w.last.width() != width || w.last.height() != height) w = {{}, {shape.format, width, height}};
    if (auto done = w.tiles.decode(packed, codec_, w.last.view()); !done) return done.error();
    const compositor::MutablePlaneView last = w.last.view();
    if (asColours_)
        swapRedAndBlue(last.pixels, into.data(), into.size() / 4);
    else
        std::memcpy(into.data(), last.pixels, into.size());
    return {};
}

void PictureUnpacker::clientGone(uint32_t client) {
    std::erase_if(windows_, [&](const auto& w) { return w.first.first == client; });
}

} // namespace mural
