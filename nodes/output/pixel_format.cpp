#include "nodes/output/pixel_format.hpp"

#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace mural {

static_assert(std::endian::native == std::endian::little, "pixels are written as machine words");

namespace {

bool contiguous(uint32_t mask) {
    if (mask == 0) return false;
    const uint32_t low = mask >> std::countr_zero(mask);
    return (low & (low + 1)) == 0;
}

// Returns OpenGL's value of a channel with another bit count [OpenGL 4.6 §2.3.5]: value / largest * newLargest,
// rounded. A mask without bits gives zeros.
std::vector<uint32_t> channelTable(int sourceBits, uint32_t mask) {
    const uint64_t largest = (uint64_t{1} << sourceBits) - 1;
    std::vector<uint32_t> table(largest + 1);
    if (mask == 0) return table;
    const int shift = std::countr_zero(mask);
    const uint64_t newLargest = mask >> shift;
    for (uint64_t value = 0; value <= largest; ++value)
        table[value] = static_cast<uint32_t>((2 * value * newLargest + largest) / (2 * largest)) << shift;
    return table;
}

bool hasMasks(const PixelFormat& format, uint32_t red, uint32_t green, uint32_t blue) {
    return format.bitsPerPixel == 32 && format.redMask == red && format.greenMask == green && format.blueMask == blue;
}

} // namespace

Result<PixelConverter> PixelConverter::make(const PixelFormat& format) {
    if (!contiguous(format.redMask) || !contiguous(format.greenMask) || !contiguous(format.blueMask)) {
        return Error{fmt::format("unknown channel masks of pixels: {:#x} {:#x} {:#x}", format.redMask, format.greenMask,
                                 format.blueMask)};
    }
    if (format.bitsPerPixel % 8 != 0 || format.bitsPerPixel < 8 || format.bitsPerPixel > 32 ||
        format.rowPadBits % 8 != 0 || format.rowPadBits < 8)
        return Error{fmt::format("pixels with {} bits are not supported", format.bitsPerPixel)};
    PixelConverter converter;
    converter.format_ = format;
    converter.bytesPerPixel_ = static_cast<size_t>(format.bitsPerPixel) / 8;
    converter.sameLayout_ = {hasMasks(format, 0xff0000, 0xff00, 0xff), hasMasks(format, 0x3ff00000, 0xffc00, 0x3ff)};
    const uint32_t depthMask = format.depth >= 32 ? ~0U : (1U << format.depth) - 1;
    const uint32_t rest = depthMask & ~(format.redMask | format.greenMask | format.blueMask);
    const uint32_t alphaMask = contiguous(rest) ? rest : 0;
    converter.tables_ = {tablesOf(PictureFormat::Bgra8, format, alphaMask),
                         tablesOf(PictureFormat::Bgr10A2, format, alphaMask)};
    return converter;
}

size_t PixelConverter::rowBytes(int width) const {
    const size_t padBytes = static_cast<size_t>(format_.rowPadBits) / 8;
    return (static_cast<size_t>(width) * bytesPerPixel_ + padBytes - 1) / padBytes * padBytes;
}

PixelConverter::Tables PixelConverter::tablesOf(PictureFormat source, const PixelFormat& format, uint32_t alphaMask) {
    const bool deep = source == PictureFormat::Bgr10A2;
    const int bits = deep ? 10 : 8;
    return {bits, channelTable(bits, format.blueMask), channelTable(bits, format.greenMask),
            channelTable(bits, format.redMask), channelTable(deep ? 2 : 8, alphaMask)};
}

void PixelConverter::convertRow(PictureFormat format, const std::byte* source, int pixels, std::byte* target) const {
    const auto index = static_cast<size_t>(format);
    if (sameLayout_[index]) {
        std::memcpy(target, source, static_cast<size_t>(pixels) * 4);
        return;
    }
    const Tables& tables = tables_[index];
    switch (bytesPerPixel_) {
    case 1: convertByTable<1>(tables, source, pixels, target); break;
    case 2: convertByTable<2>(tables, source, pixels, target); break;
    case 3: convertByTable<3>(tables, source, pixels, target); break;
    default: convertByTable<4>(tables, source, pixels, target); break;
    }
}

template <size_t Bytes>
void PixelConverter::convertByTable(const Tables& tables, const std::byte* source, int pixels, std::byte* target) {
    const uint32_t colourMask = (1U << tables.bits) - 1;
    for (int x = 0; x < pixels; ++x) {
        uint32_t word = 0;
        std::memcpy(&word, source, sizeof word);
        const uint32_t pixel = tables.blue[word & colourMask] | tables.green[word >> tables.bits & colourMask] |
                               tables.red[word >> (2 * tables.bits) & colourMask] |
                               tables.alpha[word >> (3 * tables.bits)];
        std::memcpy(target, &pixel, Bytes);
        source += sizeof word;
        target += Bytes;
    }
}

} // namespace mural
