#include "compositor/codecs/bitplane/tile_encoder.hpp"

#include <algorithm>
#include <cstring>

#include "compositor/codecs/bitplane/strip_code.hpp"
#include "compositor/kernels/find_first_difference.hpp"

namespace mural::compositor::bitplane {

namespace {

bool areUniform(const TileShape& s, unsigned count, const std::byte* rows, ptrdiff_t strideBytes) {
    std::byte repeated[16];
    for (size_t at = 0; at < sizeof repeated; at += s.pixelBytes()) std::memcpy(repeated + at, rows, s.pixelBytes());
    uint32_t pattern[4];
    std::memcpy(pattern, repeated, sizeof pattern);
    constexpr uint32_t kWhole[4] = {~0u, ~0u, ~0u, ~0u};
    for (unsigned y = 0; y < count; ++y, rows += strideBytes)
        if (findFirstDifference(reinterpret_cast<const uint32_t*>(rows), s.columns, pattern, kWhole) != s.columns)
            return false;
    return true;
}

// Repeats the last column and row up to whole blocks: their residuals equal those of their neighbours, or zero.
void padTile(const TileShape& s, const std::byte* rows, ptrdiff_t strideBytes, std::byte* into) {
    const size_t paddedBytes = size_t{4} * kBlockColumns * s.wholeBlocks();
    for (unsigned y = 0; y < s.wholeStrips() * kStripRows; ++y, into += kTileRowBytes) {
        const std::byte* row = rows + std::min(y, s.rows - 1) * strideBytes;
        std::memcpy(into, row, s.rowBytes());
        for (size_t at = s.rowBytes(); at < paddedBytes; at += 4) std::memcpy(into + at, into + at - s.pixelBytes(), 4);
    }
}

} // namespace

void TileEncoder::begin(const TileShape& shape, const std::byte* rows, ptrdiff_t strideBytes, Predictor predictor) {
    shape_ = shape;
    predictor_ = predictor;
    rows_ = pixels_ = rows;
    strideBytes_ = pixelStrideBytes_ = strideBytes;
    if (!strips_) strips_ = std::make_unique_for_overwrite<std::byte[]>(kTileBoundBytes);
    if (!shape.hasWholeBlocks()) {
        if (!padded_) padded_ = std::make_unique_for_overwrite<std::byte[]>(kTileBytes);
        padTile(shape, rows, strideBytes, padded_.get());
        pixels_ = padded_.get();
        pixelStrideBytes_ = kTileRowBytes;
    }
    const size_t pixel = shape.pixelBytes();
    std::memset(above_.data(), 0, pixel);
    std::memcpy(above_.data() + pixel, pixels_, size_t{4} * kBlockColumns * shape.wholeBlocks() - pixel);
    uniform_ = areUniform(shape, shape.rowsFrom(0), rows, strideBytes);
    raw_ = false;
    strips_[0] = static_cast<std::byte>(static_cast<unsigned>(TileKind::Strips) + static_cast<unsigned>(predictor));
    size_ = 1;
}

void TileEncoder::strip(unsigned y) {
    if (raw_ && !uniform_) return;
    const std::byte* row = pixels_ + y * pixelStrideBytes_;
    const StripKind kind{shape_.arithmetic, predictor_, y == 0};
    const StripSource source{row, pixelStrideBytes_, y == 0 ? above_.data() : row - pixelStrideBytes_,
                             y == 0 ? nullptr : row - 2 * pixelStrideBytes_, shape_.wholeBlocks()};
    const size_t written = encodeStrip(source, kind, strips_.get() + size_);
    size_ += written;
    if (y > 0 && written != kStripHeadBytes) uniform_ = false; // otherwise every row equals the row above
    // Noise shows early: encoding stops for a tile that will not shrink.
    const bool hopeless = y == 2 * kStripRows && size_ > shape_.rowBytes() * 3 * kStripRows * 15 / 16;
    raw_ = raw_ || hopeless || size_ >= rawBytes();
}

size_t TileEncoder::finish(std::byte* into) {
    if (uniform_) {
        into[0] = static_cast<std::byte>(TileKind::Uniform);
        std::memcpy(into + 1, rows_, shape_.pixelBytes());
        return 1 + shape_.pixelBytes();
    }
    if (raw_) {
        into[0] = static_cast<std::byte>(TileKind::Raw);
        for (unsigned y = 0; y < shape_.rows; ++y)
            std::memcpy(into + 1 + y * shape_.rowBytes(), rows_ + y * strideBytes_, shape_.rowBytes());
        return rawBytes();
    }
    std::memcpy(into, strips_.get(), size_);
    return size_;
}

} // namespace mural::compositor::bitplane
