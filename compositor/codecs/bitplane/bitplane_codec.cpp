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

Result<void> BitplaneCodec::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    const auto damaged = [&](const char* what) { return damagedPlane(name(), into, bytes.size(), what); };
    if (into.empty()) return bytes.empty() ? Result<void>() : damaged("an empty plane has no bytes");
    const TileGridOf grid(shapeOf(into));
    if (bytes.size() < 4 * grid.count()) return damaged("its table of tiles is cut short");
    std::span<const std::byte> left = bytes.subspan(4 * grid.count());
    const char* wrong = nullptr;
    grid.forEach([&](size_t number, const TileShape& shape, size_t column, int32_t row) {
        const size_t size = loadLittle<uint32_t>(bytes.data() + 4 * number);
        if (size > left.size()) wrong = "a tile is cut short";
        else wrong = coder_.decode(shape, left.first(size), into.row(row) + column, into.strideBytes);
        if (!wrong) left = left.subspan(size);
        return !wrong;
    });
    if (wrong) return damaged(wrong);
    if (!left.empty()) return damaged("there are bytes behind the last tile");
    return {};
}

} // namespace mural::compositor
