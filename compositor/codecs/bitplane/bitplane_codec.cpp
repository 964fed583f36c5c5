#include "compositor/codecs/bitplane/bitplane_codec.hpp"

#include <algorithm>

#include "common/little_endian.hpp"

namespace mural::compositor {

namespace {

using namespace bitplane;

// A plane of large pixels is one of words.
struct TileGridOf {
    explicit TileGridOf(const PlaneShape& s)
        : wordsPerPixel(static_cast<unsigned>(bytesPerPixel(s.format) / 4)), columns(static_cast<unsigned>(s.width) * wordsPerPixel), rows(static_cast<unsigned>(s.height)),
          tilesAcross((columns + kTileColumns - 1) / kTileColumns), tilesUp((rows + kTileRows - 1) / kTileRows), arithmetic(arithmeticOf(s.format)) {}

    [[nodiscard]] size_t count() const { return size_t{tilesAcross} * tilesUp; }
    [[nodiscard]] TileShape shape(unsigned across, unsigned up) const {
        return {std::min(kTileColumns, columns - across * kTileColumns), std::min(kTileRows, rows - up * kTileRows), wordsPerPixel, arithmetic};
    }
    // Calls each(tile's number, shape, offset of its first byte in a row, its first row) until it returns false.
    template <class Each> void forEach(Each&& each) const {
        size_t number = 0;
        for (unsigned up = 0; up < tilesUp; ++up)
            for (unsigned across = 0; across < tilesAcross; ++across, ++number)
                if (!each(number, shape(across, up), size_t{4} * kTileColumns * across, static_cast<int32_t>(kTileRows * up))) return;
    }
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
    size_t size = 4 * grid.count();
    grid.forEach([&](size_t number, const TileShape& shape, size_t column, int32_t row) {
        const size_t written = coder_.encode(shape, plane.row(row) + column, plane.strideBytes, predictor_, into.data() + size);
        storeLittle(into.data() + 4 * number, static_cast<uint32_t>(written));
        size += written;
        return true;
    });
    return size;
}

namespace {

// Takes the table of sizes apart: calls each(shape of the tile, its bytes, offset of its first byte in a row, its first row),
// which returns what is wrong with it, or null. Returns the same for the plane.
template <class Each> const char* forEachEncodedTile(std::span<const std::byte> bytes, const TileGridOf& grid, Each&& each) {
    if (bytes.size() < 4 * grid.count()) return "its table of tiles is cut short";
    std::span<const std::byte> left = bytes.subspan(4 * grid.count());
    const char* wrong = nullptr;
    grid.forEach([&](size_t number, const TileShape& shape, size_t column, int32_t row) {
        const size_t size = loadLittle<uint32_t>(bytes.data() + 4 * number);
        if (size > left.size()) wrong = "a tile is cut short";
        else wrong = each(shape, left.first(size), column, row);
        if (!wrong) left = left.subspan(size);
        return !wrong;
    });
    if (wrong) return wrong;
    return left.empty() ? nullptr : "there are bytes behind the last tile";
}

} // namespace

Result<void> BitplaneCodec::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    if (into.empty()) return bytes.empty() ? Result<void>() : damagedPlane(name(), into, bytes.size(), "an empty plane has no bytes");
    const char* wrong = forEachEncodedTile(bytes, TileGridOf(shapeOf(into)), [&](const TileShape& shape, std::span<const std::byte> tile, size_t column, int32_t row) {
        return coder_.decode(shape, tile, into.row(row) + column, into.strideBytes);
    });
    return wrong ? damagedPlane(name(), into, bytes.size(), wrong) : Result<void>();
}

Result<void> BitplaneCodec::decodeTiles(std::span<const std::byte> bytes, const PlaneShape& shape, const EachTile& each) {
    const PlaneView whole{shape.format, shape.width, shape.height, 0, nullptr}; // for what is said of it
    if (whole.empty()) return bytes.empty() ? Result<void>() : damagedPlane(name(), whole, bytes.size(), "an empty plane has no bytes");
    constexpr ptrdiff_t kStrideBytes = ptrdiff_t{4} * kTileColumns;
    tile_.resize(kTileBytes);
    const auto pixelBytes = static_cast<int32_t>(bytesPerPixel(shape.format));
    const char* wrong = forEachEncodedTile(bytes, TileGridOf(shape), [&](const TileShape& tile, std::span<const std::byte> encoded, size_t column, int32_t row) {
        const char* fault = coder_.decode(tile, encoded, tile_.data(), kStrideBytes);
        if (fault) return fault;
        const PixelViewport area{static_cast<int32_t>(column) / pixelBytes, row, static_cast<int32_t>(tile.columns / tile.wordsPerPixel), static_cast<int32_t>(tile.rows)};
        each(area, {shape.format, area.w, area.h, kStrideBytes, tile_.data()});
        return fault;
    });
    return wrong ? damagedPlane(name(), whole, bytes.size(), wrong) : Result<void>();
}

} // namespace mural::compositor
