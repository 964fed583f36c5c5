#include "compositor/codecs/bitplane/tile_code.hpp"

#include <algorithm>
#include <cstring>

#include "compositor/codecs/bitplane/strip_code.hpp"
#include "compositor/kernels/ask_ahead.hpp"
#include "compositor/kernels/find_unlike.hpp"

namespace mural::compositor::bitplane {

namespace {

enum class TileKind : uint8_t { Raw = 0, Uniform = 1, Strips = 2 }; // Strips: plus the predictor's number

unsigned wholeBlocks(const TileShape& s) { return (s.columns + kBlockColumns - 1) / kBlockColumns; }
unsigned wholeStrips(const TileShape& s) { return (s.rows + kStripRows - 1) / kStripRows; }
bool hasWholeBlocks(const TileShape& s) { return s.columns % kBlockColumns == 0 && s.rows % kStripRows == 0; }

bool isUniform(const TileShape& s, const std::byte* rows, ptrdiff_t strideBytes) {
    std::byte repeated[16];
    for (size_t at = 0; at < sizeof repeated; at += 4 * s.wordsPerPixel) std::memcpy(repeated + at, rows, 4 * s.wordsPerPixel);
    uint32_t pattern[4];
    std::memcpy(pattern, repeated, sizeof pattern);
    constexpr uint32_t kWhole[4] = {~0u, ~0u, ~0u, ~0u};
    for (unsigned y = 0; y < s.rows; ++y, rows += strideBytes) {
        if (y + kStripRows < s.rows) askFor(rows + kStripRows * strideBytes, size_t{4} * s.columns); // rows are short
        if (findUnlike(reinterpret_cast<const uint32_t*>(rows), s.columns, pattern, kWhole) != s.columns) return false;
    }
    return true;
}

// The last column and row once more, up to whole blocks: their residuals are those of their neighbours, or zero.
void padTile(const TileShape& s, const std::byte* rows, ptrdiff_t strideBytes, std::byte* into) {
    const size_t paddedBytes = size_t{4} * kBlockColumns * wholeBlocks(s);
    for (unsigned y = 0; y < wholeStrips(s) * kStripRows; ++y, into += 4 * kTileColumns) {
        const std::byte* row = rows + std::min(y, s.rows - 1) * strideBytes;
        std::memcpy(into, row, 4 * s.columns);
        const size_t pixel = 4 * s.wordsPerPixel;
        for (size_t at = 4 * s.columns; at < paddedBytes; at += 4) std::memcpy(into + at, into + at - pixel, 4);
    }
}

} // namespace

TileCoder::TileCoder() : scratch_(std::make_unique<Scratch>()) {}

size_t TileCoder::encode(const TileShape& shape, const std::byte* rows, ptrdiff_t strideBytes, Predictor predictor, std::byte* into) {
    if (isUniform(shape, rows, strideBytes)) {
        into[0] = static_cast<std::byte>(TileKind::Uniform);
        std::memcpy(into + 1, rows, 4 * shape.wordsPerPixel);
        return 1 + size_t{4} * shape.wordsPerPixel;
    }
    const std::byte* pixels = rows;
    ptrdiff_t stride = strideBytes;
    if (!hasWholeBlocks(shape)) {
        padTile(shape, rows, strideBytes, scratch_->pixels);
        pixels = scratch_->pixels;
        stride = 4 * kTileColumns;
    }
    // Row 0 is predicted from the pixel on its left.
    const size_t pixel = 4 * shape.wordsPerPixel;
    std::memset(scratch_->above, 0, pixel);
    std::memcpy(scratch_->above + pixel, pixels, size_t{4} * kBlockColumns * wholeBlocks(shape) - pixel);

    const size_t rowBytes = 4 * shape.columns, rawBytes = 1 + rowBytes * shape.rows;
    into[0] = static_cast<std::byte>(static_cast<unsigned>(TileKind::Strips) + static_cast<unsigned>(predictor));
    size_t size = 1;
    for (unsigned y = 0; y < shape.rows; y += kStripRows) {
        const std::byte* row = pixels + y * stride;
        const bool moreBelow = y + 2 * kStripRows <= shape.rows;
        const StripKind kind{shape.arithmetic, predictor, y == 0};
        const StripSource source{row, stride, y == 0 ? scratch_->above : row - stride, y == 0 ? nullptr : row - 2 * stride, wholeBlocks(shape), moreBelow};
        size += encodeStrip(source, kind, into + size);
        // Noise shows early: no time is spent on a tile that won't be smaller.
        const bool hopeless = y == 2 * kStripRows && size > rowBytes * 3 * kStripRows * 15 / 16;
        if (size < rawBytes && !hopeless) continue;
        into[0] = static_cast<std::byte>(TileKind::Raw);
        for (unsigned r = 0; r < shape.rows; ++r) std::memcpy(into + 1 + r * rowBytes, rows + r * strideBytes, rowBytes);
        return rawBytes;
    }
    return size;
}

const char* TileCoder::decode(const TileShape& shape, std::span<const std::byte> bytes, std::byte* rows, ptrdiff_t strideBytes) {
    if (bytes.empty()) return "a tile has no bytes";
    const size_t rowBytes = size_t{4} * shape.columns;
    const auto kind = std::to_integer<unsigned>(bytes[0]);
    const std::span<const std::byte> rest = bytes.subspan(1);
    if (kind == static_cast<unsigned>(TileKind::Raw)) {
        if (rest.size() != rowBytes * shape.rows) return "a raw tile has another size";
        for (unsigned y = 0; y < shape.rows; ++y) std::memcpy(rows + y * strideBytes, rest.data() + y * rowBytes, rowBytes);
        return nullptr;
    }
    if (kind == static_cast<unsigned>(TileKind::Uniform)) {
        const size_t pixel = size_t{4} * shape.wordsPerPixel;
        if (rest.size() != pixel) return "a uniform tile has another size than its pixel";
        for (size_t at = 0; at < rowBytes; at += 4) std::memcpy(rows + at, rest.data() + at % pixel, 4);
        for (unsigned y = 1; y < shape.rows; ++y) std::memcpy(rows + y * strideBytes, rows, rowBytes);
        return nullptr;
    }
    if (kind > static_cast<unsigned>(TileKind::Strips) + static_cast<unsigned>(Predictor::Slope)) return "a tile is of an unknown kind";
    const auto predictor = static_cast<Predictor>(kind - static_cast<unsigned>(TileKind::Strips));
    if (rest.size() > kTileBoundBytes) return "a tile is larger than any";
    if (hasWholeBlocks(shape)) return decodeStrips(shape, rest, predictor, rows, strideBytes);
    if (const char* wrong = decodeStrips(shape, rest, predictor, scratch_->pixels, 4 * kTileColumns)) return wrong;
    for (unsigned y = 0; y < shape.rows; ++y) std::memcpy(rows + y * strideBytes, scratch_->pixels + y * size_t{4} * kTileColumns, rowBytes);
    return nullptr;
}

const char* TileCoder::decodeStrips(const TileShape& shape, std::span<const std::byte> bytes, Predictor predictor, std::byte* rows, ptrdiff_t strideBytes) {
    std::span<const std::byte> left = bytes;
    bool moved = false;
    std::memset(scratch_->above, 0, sizeof scratch_->above);
    ParsedStrip strip;
    for (unsigned y = 0; y < shape.rows; y += kStripRows) {
        // Unpacking reads behind a channel; so the last ones get bytes behind them.
        if (!moved && left.size() < kStripBoundBytes + kSlackBytes) {
            std::memcpy(scratch_->ending, left.data(), left.size());
            left = {scratch_->ending, left.size()};
            moved = true;
        }
        const size_t size = parseStrip(left, wholeBlocks(shape), strip);
        if (size == 0) return "a strip is cut short or holds an impossible width";
        left = left.subspan(size);
        std::byte* row = rows + y * strideBytes;
        const bool moreBelow = y + 2 * kStripRows <= shape.rows;
        const StripKind kind{shape.arithmetic, predictor, y == 0};
        const StripTarget target{row, strideBytes, y == 0 ? scratch_->above : row - strideBytes, y == 0 ? nullptr : row - 2 * strideBytes, wholeBlocks(shape), moreBelow};
        decodeStrip(strip, kind, target);
        if (y == 0) finishFirstStrip(target, shape.arithmetic, shape.wordsPerPixel);
    }
    return left.empty() ? nullptr : "a tile has bytes behind its end";
}

} // namespace mural::compositor::bitplane
