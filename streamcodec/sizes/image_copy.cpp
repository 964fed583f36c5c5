// Copies images between client memory and the tight form.
#include "streamcodec/sizes/pixel_format.hpp"

#include <cstring>

#include "streamcodec/sizes/bitmap_rows.hpp"

namespace mural::sizes {
namespace {

void copySwapped2(uint8_t* dst, const uint8_t* src, size_t size) {
    for (size_t i = 0; i + 2 <= size; i += 2) {
        uint16_t value = 0;
        std::memcpy(&value, src + i, sizeof value);
        value = __builtin_bswap16(value);
        std::memcpy(dst + i, &value, sizeof value);
    }
}

void copySwapped4(uint8_t* dst, const uint8_t* src, size_t size) {
    for (size_t i = 0; i + 4 <= size; i += 4) {
        uint32_t value = 0;
        std::memcpy(&value, src + i, sizeof value);
        value = __builtin_bswap32(value);
        std::memcpy(dst + i, &value, sizeof value);
    }
}

void copyRow(uint8_t* dst, const uint8_t* src, const ImageLayout& layout) {
    if (layout.swapUnit == 2)
        copySwapped2(dst, src, layout.rowBytes);
    else if (layout.swapUnit == 4)
        copySwapped4(dst, src, layout.rowBytes);
    else
        std::memcpy(dst, src, layout.rowBytes);
}

BitmapRow bitmapRow(const ImageLayout& layout) { return {layout.firstBit, layout.width, layout.lsbFirst}; }

// True if the client's rows are contiguous and in the order of the tight image.
bool isContiguous(const ImageLayout& layout) {
    return !layout.bitmap && layout.swapUnit == 0 && layout.rowStride == static_cast<ptrdiff_t>(layout.rowBytes) &&
           (layout.images == 1 || layout.imageStride == layout.rowBytes * layout.rows);
}

} // namespace

void packTight(void* dst, const void* src, const ImageLayout& layout) {
    if (!layout.known) return;
    auto* out = static_cast<uint8_t*>(dst);
    const auto* client = static_cast<const uint8_t*>(src);
    if (isContiguous(layout)) {
        std::memcpy(out, client + layout.firstByte, tightBytes(layout));
        return;
    }
    for (uint32_t image = 0; image < layout.images; ++image) {
        for (uint32_t row = 0; row < layout.rows; ++row, out += layout.rowBytes) {
            const uint8_t* from = client + layout.rowOffset(row, image);
            if (layout.bitmap)
                packBitmapRow(out, from, bitmapRow(layout));
            else
                copyRow(out, from, layout);
        }
    }
}

void unpackTight(void* dst, const void* tightSrc, const ImageLayout& layout) {
    if (!layout.known) return;
    auto* client = static_cast<uint8_t*>(dst);
    const auto* in = static_cast<const uint8_t*>(tightSrc);
    if (isContiguous(layout)) {
        std::memcpy(client + layout.firstByte, in, tightBytes(layout));
        return;
    }
    for (uint32_t image = 0; image < layout.images; ++image) {
        for (uint32_t row = 0; row < layout.rows; ++row, in += layout.rowBytes) {
            uint8_t* to = client + layout.rowOffset(row, image);
            if (layout.bitmap)
                unpackBitmapRow(to, in, bitmapRow(layout));
            else
                copyRow(to, in, layout);
        }
    }
}

} // namespace mural::sizes
