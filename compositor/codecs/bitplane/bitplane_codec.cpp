#include "compositor/codecs/bitplane/bitplane_codec.hpp"

#include <algorithm>

#include "common/base/little_endian.hpp"

namespace mural::compositor {

namespace {

using namespace bitplane;

// A plane of larger pixels is treated as a plane of words.
struct TileGridOf {
    explicit TileGridOf(const PlaneShape& s)
        : wordsPerPixel(static_cast<unsigned>(bytesPerPixel(s.format) / 4)),
          columns(static_cast<unsigned>(s.width) * wordsPerPixel),
          rows(static_cast<unsigned>(s.height)),
          tilesAcross((columns + kTileColumns - 1) / kTileColumns),
          tilesUp((rows + kTileRows - 1) / kTileRows),
          arithmetic(arithmeticOf(s.format)) {}

    [[nodiscard]] size_t count() const { return size_t{tilesAcross} * tilesUp; }
    [[nodiscard]] TileShape shape(unsigned across, unsigned up) const {
        return {std::min(kTileColumns, columns - across * kTileColumns), std::min(kTileRows, rows - up * kTileRows),
                wordsPerPixel, arithmetic};
    }
    // First row of words of a row of tiles, and their number.
    [[nodiscard]] static int32_t firstRow(unsigned up) { return static_cast<int32_t>(kTileRows * up); }
    [[nodiscard]] unsigned rowsOf(unsigned up) const { return std::min(kTileRows, rows - up * kTileRows); }
    unsigned wordsPerPixel, columns, rows, tilesAcross, tilesUp;
    Arithmetic arithmetic;
};

} // namespace

size_t BitplaneCodec::boundBytes(const PlaneShape& shape) const {
    if (shape.width <= 0 || shape.height <= 0) return 0;
    return TileGridOf(shape).count() * (4 + kTileBoundBytes);
}

Result<size_t> BitplaneCodec::encode(const PlaneView& plane, std::span<std::byte> into) {
    if (plane.empty()) return size_t{0};
    const TileGridOf grid(shapeOf(plane));
    if (encoders_.size() < grid.tilesAcross) encoders_.resize(grid.tilesAcross);
    const auto encoders = std::span(encoders_).first(grid.tilesAcross);
    size_t size = 4 * grid.count();
    std::byte* table = into.data();
    for (unsigned up = 0; up < grid.tilesUp; ++up) {
        for (unsigned across = 0; across < grid.tilesAcross; ++across)
            encoders[across].begin(grid.shape(across, up), plane.row(grid.firstRow(up)) + kTileRowBytes * across,
                                   plane.strideBytes, predictor_);
        for (unsigned y = 0; y < grid.rowsOf(up); y += kStripRows)
            for (TileEncoder& encoder : encoders) encoder.strip(y);
        for (TileEncoder& encoder : encoders) {
            const size_t written = encoder.finish(into.data() + size);
            storeLittle(table, static_cast<uint32_t>(written));
            table += 4;
            size += written;
        }
    }
    return size;
}

namespace {

// The table of sizes, followed by the tiles.
class EncodedTiles {
public:
    EncodedTiles(std::span<const std::byte> bytes, const TileGridOf& grid) : whole_(bytes.size() >= 4 * grid.count()) {
        if (whole_) table_ = bytes.data(), left_ = bytes.subspan(4 * grid.count());
    }
    // Returns null, or the error.
    [[nodiscard]] const char* wrong() const { return whole_ ? nullptr : "its table of tiles is truncated"; }
    const char* next(std::span<const std::byte>& tile) {
        const size_t size = loadLittle<uint32_t>(table_);
        if (size > left_.size()) return "a tile is truncated";
        tile = left_.first(size);
        left_ = left_.subspan(size);
        table_ += 4;
        return nullptr;
    }
    [[nodiscard]] const char* ends() const { return left_.empty() ? nullptr : "there are bytes after the last tile"; }

private:
    bool whole_;
    const std::byte* table_ = nullptr;
    std::span<const std::byte> left_;
};

const char* decodeRowOfTiles(EncodedTiles& tiles, const TileGridOf& grid, unsigned up, std::span<TileDecoder> decoders,
                             const MutablePlaneView& into) {
    std::span<const std::byte> tile;
    for (unsigned across = 0; across < grid.tilesAcross; ++across) {
        if (const char* wrong = tiles.next(tile)) return wrong;
        if (const char* wrong = decoders[across].begin(
                grid.shape(across, up), tile, into.row(grid.firstRow(up)) + kTileRowBytes * across, into.strideBytes))
            return wrong;
    }
    for (unsigned y = 0; y < grid.rowsOf(up); y += kStripRows)
        for (TileDecoder& decoder : decoders)
            if (const char* wrong = decoder.strip(y)) return wrong;
    for (const TileDecoder& decoder : decoders)
        if (const char* wrong = decoder.finish()) return wrong;
    return nullptr;
}

} // namespace

Result<void> BitplaneCodec::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    if (into.empty())
        return bytes.empty() ? Result<void>() : damagedPlane(name(), into, bytes.size(), "an empty plane has no bytes");
    const TileGridOf grid(shapeOf(into));
    if (decoders_.size() < grid.tilesAcross) decoders_.resize(grid.tilesAcross);
    EncodedTiles tiles(bytes, grid);
    const char* wrong = tiles.wrong();
    for (unsigned up = 0; up < grid.tilesUp && !wrong; ++up)
        wrong = decodeRowOfTiles(tiles, grid, up, std::span(decoders_).first(grid.tilesAcross), into);
    if (!wrong) wrong = tiles.ends();
    return wrong ? damagedPlane(name(), into, bytes.size(), wrong) : Result<void>();
}

Result<void> BitplaneCodec::decodeTiles(std::span<const std::byte> bytes, const PlaneShape& shape,
                                        const EachTile& each) {
    const PlaneView whole{shape.format, shape.width, shape.height, 0, nullptr}; // for error messages
    if (whole.empty())
        return bytes.empty() ? Result<void>()
                             : damagedPlane(name(), whole, bytes.size(), "an empty plane has no bytes");
    tile_.resize(kTileBytes);
    if (decoders_.empty()) decoders_.resize(1);
    TileDecoder& decoder = decoders_.front();
    const auto pixelBytes = static_cast<int32_t>(bytesPerPixel(shape.format));
    const TileGridOf grid(shape);
    EncodedTiles tiles(bytes, grid);
    const char* wrong = tiles.wrong();
    std::span<const std::byte> encoded;
    for (unsigned number = 0; number < grid.count() && !wrong; ++number) {
        const unsigned across = number % grid.tilesAcross, up = number / grid.tilesAcross;
        const TileShape tile = grid.shape(across, up);
        wrong = tiles.next(encoded);
        if (!wrong) wrong = decoder.begin(tile, encoded, tile_.data(), kTileRowBytes);
        for (unsigned y = 0; y < tile.rows && !wrong; y += kStripRows) wrong = decoder.strip(y);
        if (!wrong) wrong = decoder.finish();
        if (wrong) break;
        const PixelViewport area{static_cast<int32_t>(kTileRowBytes * across) / pixelBytes, grid.firstRow(up),
                                 static_cast<int32_t>(tile.columns / tile.wordsPerPixel),
                                 static_cast<int32_t>(tile.rows)};
        each(area, {shape.format, area.w, area.h, kTileRowBytes, tile_.data()});
    }
    if (!wrong) wrong = tiles.ends();
    return wrong ? damagedPlane(name(), whole, bytes.size(), wrong) : Result<void>();
}

} // namespace mural::compositor
