#include "compositor/codecs/tile_delta.hpp"

#include <algorithm>
#include <cstring>

#include "common/base/little_endian.hpp"

namespace mural::compositor {

namespace {

struct Tiles {
    Tiles(int32_t w, int32_t h)
        : width(w),
          height(h),
          across((w + kSkippedTileColumns - 1) / kSkippedTileColumns),
          up((h + kSkippedTileRows - 1) / kSkippedTileRows) {}
    [[nodiscard]] size_t count() const { return static_cast<size_t>(across) * static_cast<size_t>(up); }
    [[nodiscard]] size_t headBytes() const { return 8 + (count() + 7) / 8; }
    // Area of tiles first ... end-1 of row y.
    [[nodiscard]] PixelViewport area(int32_t y, int32_t first, int32_t end) const {
        const int32_t x0 = first * kSkippedTileColumns, y0 = y * kSkippedTileRows;
        return {x0, y0, std::min(width, end * kSkippedTileColumns) - x0, std::min(height, y0 + kSkippedTileRows) - y0};
    }
    // Calls each(row, first, end) for runs of marked tiles until it returns false.
    template <class IsMarked, class Each> void forRuns(IsMarked&& marked, Each&& each) const {
        for (int32_t y = 0; y < up; ++y)
            for (int32_t x = 0; x < across;) {
                const int32_t first = x;
                while (x < across &&
                       marked(static_cast<size_t>(y) * static_cast<size_t>(across) + static_cast<size_t>(x)))
                    ++x;
                if (x > first && !each(y, first, x)) return;
                if (x == first) ++x;
            }
    }
    int32_t width, height, across, up;
};

} // namespace

size_t TileDeltaEncoder::boundBytes(const PlaneShape& shape, const Codec& codec) const {
    if (shape.width <= 0 || shape.height <= 0) return 0;
    const Tiles tiles(shape.width, shape.height);
    // Upper bound: one run per tile.
    return tiles.headBytes() +
           tiles.count() * (4 + codec.boundBytes({shape.format, std::min(shape.width, kSkippedTileColumns),
                                                  std::min(shape.height, kSkippedTileRows)})) +
           codec.boundBytes(shape);
}

Result<size_t> TileDeltaEncoder::encode(const PlaneView& plane, Codec& codec, std::span<std::byte> into) {
    changed_ = 0;
    if (plane.empty()) return size_t{0};
    const Tiles tiles(plane.width, plane.height);
    if (shape_.format != plane.format || shape_.width != plane.width || shape_.height != plane.height) names_.clear();
    shape_ = shapeOf(plane);
    const bool whole = names_.empty();
    names_.resize(tiles.count());
    const uint32_t before = whole ? 0 : number_;
    number_ = number_ == UINT32_MAX ? 1 : number_ + 1;
    storeLittle(into.data(), number_);
    storeLittle(into.data() + 4, before);
    std::byte* bits = into.data() + 8;
    std::memset(bits, 0, tiles.headBytes() - 8);
    for (size_t t = 0; t < tiles.count(); ++t) {
        const auto x = static_cast<int32_t>(t) % tiles.across, y = static_cast<int32_t>(t) / tiles.across;
        const TileHash name = hashOf(plane.part(tiles.area(y, x, x + 1)));
        if (!whole && name == names_[t]) continue;
        names_[t] = name;
        bits[t / 8] |= std::byte{1} << (t % 8);
        ++changed_;
    }
    size_t size = tiles.headBytes();
    Result<size_t> last = size_t{0};
    tiles.forRuns([&](size_t t) { return std::to_integer<unsigned>(bits[t / 8] >> (t % 8) & std::byte{1}) != 0; },
                  [&](int32_t y, int32_t first, int32_t end) {
                      last = codec.encode(plane.part(tiles.area(y, first, end)), into.subspan(size + 4));
                      if (!last) return false;
                      storeLittle(into.data() + size, static_cast<uint32_t>(*last));
                      size += 4 + *last;
                      return true;
                  });
    if (last) return size;
    restart(); // this plane is not sent
    return last;
}

Result<void> TileDeltaDecoder::decode(std::span<const std::byte> bytes, Codec& codec, const MutablePlaneView& into) {
    const auto damaged = [&](const char* what) {
        number_ = 0;
        return damagedPlane("tile delta", into, bytes.size(), what);
    };
    if (into.empty()) return bytes.empty() ? Result<void>() : damaged("an empty plane has no bytes");
    const Tiles tiles(into.width, into.height);
    if (bytes.size() < tiles.headBytes()) return damaged("its header is truncated");
    const uint32_t number = loadLittle<uint32_t>(bytes.data()), before = loadLittle<uint32_t>(bytes.data() + 4);
    const auto present = [&](size_t t) {
        return std::to_integer<unsigned>(bytes[8 + t / 8] >> (t % 8) & std::byte{1}) != 0;
    };
    if (number == 0) return damaged("its number is 0");
    if (before != 0 && before != number_) return damaged("its previous plane is not the current one");
    for (size_t t = 0; t < 8 * (tiles.headBytes() - 8); ++t)
        if (t < tiles.count() ? before == 0 && !present(t) : present(t))
            return damaged("its tiles do not match the plane");
    std::span<const std::byte> left = bytes.subspan(tiles.headBytes());
    Result<void> result;
    tiles.forRuns(present, [&](int32_t y, int32_t first, int32_t end) {
        const size_t size = left.size() < 4 ? 0 : loadLittle<uint32_t>(left.data());
        if (left.size() < 4 || size > left.size() - 4)
            result = damaged("a run of tiles is truncated");
        else
            result = codec.decode(left.subspan(4, size), into.part(tiles.area(y, first, end)));
        if (result) left = left.subspan(4 + size);
        return result.ok();
    });
    if (!result) {
        number_ = 0;
        return result;
    }
    if (!left.empty()) return damaged("there are bytes after its end");
    number_ = number;
    return {};
}

} // namespace mural::compositor
