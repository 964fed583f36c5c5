#include "nodes/output/pixel_format.hpp"

#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace mural {

static_assert(std::endian::native == std::endian::little, "pixels are written as machine words");

namespace {

bool contiguous(uint32_t mask) {
    if (mask == 0)
        return false;
    const uint32_t low = mask >> std::countr_zero(mask);
    return (low & (low + 1)) == 0;
}

// [OpenGL 4.6 §2.3.5] v8 / 255 * max, rounded: what OpenGL stores in a channel of fewer or more
// bits.
std::array<uint32_t, 256> channelTable(uint32_t mask) {
    const int shift = std::countr_zero(mask);
    const uint64_t largest = mask >> shift;
    std::array<uint32_t, 256> table{};
    for (uint32_t value = 0; value < 256; ++value)
        table[value] = static_cast<uint32_t>((value * largest + 127) / 255) << shift;
    return table;
}

} // namespace

Result<PixelConverter> PixelConverter::make(const PixelFormat& format) {
    if (!contiguous(format.redMask) || !contiguous(format.greenMask) ||
        !contiguous(format.blueMask)) {
        return Error{fmt::format("pixels with the channel masks {:#x} {:#x} {:#x} are not known",
                                 format.redMask, format.greenMask, format.blueMask)};
    }
    if (format.bitsPerPixel % 8 != 0 || format.bitsPerPixel < 8 || format.bitsPerPixel > 32 ||
        format.rowPadBits % 8 != 0 || format.rowPadBits < 8)
        return Error{fmt::format("pixels of {} bits are not known", format.bitsPerPixel)};
    PixelConverter converter;
    converter.format_ = format;
    converter.bytesPerPixel_ = static_cast<size_t>(format.bitsPerPixel) / 8;
    converter.sameLayout_ = format.bitsPerPixel == 32 && format.redMask == 0xff0000 &&
                            format.greenMask == 0x00ff00 && format.blueMask == 0x0000ff;
    const uint32_t depthMask = format.depth >= 32 ? ~0U : (1U << format.depth) - 1;
    converter.opaque_ = depthMask & ~(format.redMask | format.greenMask | format.blueMask);
    converter.red_ = channelTable(format.redMask);
    converter.green_ = channelTable(format.greenMask);
    converter.blue_ = channelTable(format.blueMask);
    return converter;
}

size_t PixelConverter::rowBytes(int width) const {
    const size_t padBytes = static_cast<size_t>(format_.rowPadBits) / 8;
    return (static_cast<size_t>(width) * bytesPerPixel_ + padBytes - 1) / padBytes * padBytes;
}

void PixelConverter::convertRow(const std::byte* bgra, int pixels, std::byte* target) const {
    if (sameLayout_ && opaque_ == 0) {
        std::memcpy(target, bgra, static_cast<size_t>(pixels) * 4);
        return;
    }
    if (sameLayout_) {
        for (int x = 0; x < pixels; ++x) {
            uint32_t pixel = 0;
            std::memcpy(&pixel, bgra + static_cast<size_t>(x) * 4, 4);
            pixel |= opaque_;
            std::memcpy(target + static_cast<size_t>(x) * 4, &pixel, 4);
        }
        return;
    }
    switch (bytesPerPixel_) {
    case 1:
        convertByTable<1>(bgra, pixels, target);
        break;
    case 2:
        convertByTable<2>(bgra, pixels, target);
        break;
    case 3:
        convertByTable<3>(bgra, pixels, target);
        break;
    default:
        convertByTable<4>(bgra, pixels, target);
        break;
    }
}

template <size_t Bytes>
void PixelConverter::convertByTable(const std::byte* bgra, int pixels, std::byte* target) const {
    for (int x = 0; x < pixels; ++x) {
        const uint32_t pixel = blue_[std::to_integer<size_t>(bgra[0])] |
                               green_[std::to_integer<size_t>(bgra[1])] |
                               red_[std::to_integer<size_t>(bgra[2])] | opaque_;
        std::memcpy(target, &pixel, Bytes);
        bgra += 4;
        target += Bytes;
    }
}

} // namespace mural
