#include "compositor/codecs/bitplane/tile_decoder.hpp"

#include <cstring>

#include "compositor/codecs/bitplane/strip_code.hpp"

namespace mural::compositor::bitplane {

const char* TileDecoder::begin(const TileShape& shape, std::span<const std::byte> bytes, std::byte* rows,
                               ptrdiff_t strideBytes) {
    if (bytes.empty()) return "a tile has no bytes";
    shape_ = shape;
    rows_ = pixels_ = rows;
    strideBytes_ = pixelStrideBytes_ = strideBytes;
    left_ = bytes.subspan(1);
    const auto kind = std::to_integer<unsigned>(bytes[0]);
    if (kind > static_cast<unsigned>(TileKind::Strips) + static_cast<unsigned>(Predictor::Slope))
        return "a tile has an unknown kind";
    kind_ = kind < static_cast<unsigned>(TileKind::Strips) ? static_cast<TileKind>(kind) : TileKind::Strips;
    if (kind_ == TileKind::Raw)
        return left_.size() == shape.rowBytes() * shape.rows ? nullptr : "a raw tile has a wrong size";
    if (kind_ == TileKind::Uniform) {
        const size_t pixel = shape.pixelBytes();
        if (left_.size() != pixel) return "a uniform tile has a wrong size";
        for (size_t at = 0; at < shape.rowBytes(); at += 4) std::memcpy(row_.data() + at, left_.data() + at % pixel, 4);
        return nullptr;
    }
    predictor_ = static_cast<Predictor>(kind - static_cast<unsigned>(TileKind::Strips));
    if (left_.size() > kTileBoundBytes) return "a tile exceeds the maximum size";
    row_.fill(std::byte{0});
    moved_ = false;
    if (shape.hasWholeBlocks()) return nullptr;
    if (!padded_) padded_ = std::make_unique_for_overwrite<std::byte[]>(kTileBytes);
    pixels_ = padded_.get();
    pixelStrideBytes_ = kTileRowBytes;
    return nullptr;
}

const char* TileDecoder::strip(unsigned y) {
    switch (kind_) {
    case TileKind::Raw:
        copyRows(y, left_.data() + y * shape_.rowBytes(), static_cast<ptrdiff_t>(shape_.rowBytes()));
        return nullptr;
    case TileKind::Uniform:
        if (!shape_.hasWholeBlocks()) {
            copyRows(y, row_.data(), 0);
            return nullptr;
        }
        strip_.present = 0; // decoded as a strip without differences, which writes four rows at once
        decodeStrip(strip_, {shape_.arithmetic, Predictor::Above, false},
                    {rows_ + y * strideBytes_, strideBytes_, row_.data(), nullptr, shape_.wholeBlocks()});
        return nullptr;
    case TileKind::Strips: break;
    }
    const char* wrong = packedStrip(y);
    if (!wrong && pixels_ != rows_) copyRows(y, pixels_ + y * pixelStrideBytes_, pixelStrideBytes_);
    return wrong;
}

void TileDecoder::copyRows(unsigned y, const std::byte* from, ptrdiff_t fromStrideBytes) {
    for (unsigned i = 0; i < shape_.rowsFrom(y); ++i)
        std::memcpy(rows_ + (y + i) * strideBytes_, from + i * fromStrideBytes, shape_.rowBytes());
}

const char* TileDecoder::packedStrip(unsigned y) {
    // Unpacking reads past the end of a channel, so the last strips are copied to memory with slack.
    if (!moved_ && left_.size() < kStripBoundBytes + kSlackBytes) {
        std::memcpy(ending_.data(), left_.data(), left_.size());
        left_ = {ending_.data(), left_.size()};
        moved_ = true;
    }
    const size_t size = parseStrip(left_, shape_.wholeBlocks(), strip_);
    if (size == 0) return "a strip is truncated or has an invalid width";
    left_ = left_.subspan(size);
    std::byte* row = pixels_ + y * pixelStrideBytes_;
    const StripKind kind{shape_.arithmetic, predictor_, y == 0};
    const StripTarget target{row, pixelStrideBytes_, y == 0 ? row_.data() : row - pixelStrideBytes_,
                             y == 0 ? nullptr : row - 2 * pixelStrideBytes_, shape_.wholeBlocks()};
    decodeStrip(strip_, kind, target);
    if (y == 0) finishFirstStrip(target, shape_.arithmetic, shape_.wordsPerPixel);
    return nullptr;
}

const char* TileDecoder::finish() const {
    return kind_ != TileKind::Strips || left_.empty() ? nullptr : "a tile has bytes after its end";
}

} // namespace mural::compositor::bitplane
