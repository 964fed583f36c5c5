#include "compositor/codecs/rle/rle64_codec.hpp"

#include <algorithm>
#include <cstring>

#include "common/base/little_endian.hpp"

namespace mural::compositor {

namespace {

constexpr uint32_t kRun = 0x80000000u;
constexpr size_t kShortestWords = 3; // in words; shorter runs cost more than they save

size_t wordsOfRow(size_t rowBytes) { return (rowBytes + 7) / 8; }

uint64_t wordAt(const std::byte* row, size_t rowBytes, size_t index) {
    uint64_t word = 0;
    std::memcpy(&word, row + 8 * index, std::min<size_t>(8, rowBytes - 8 * index));
    return word;
}

} // namespace

size_t Rle64Codec::boundBytes(const PlaneShape& shape) const {
    if (shape.width <= 0 || shape.height <= 0) return 0;
    // Worst case: a head per kShortestWords words, and one per row.
    const size_t words = wordsOfRow(shape.rowBytes());
    return static_cast<size_t>(shape.height) * (words * 8 + 4 * (2 * words / kShortestWords + 2));
}

Result<size_t> Rle64Codec::encode(const PlaneView& plane, std::span<std::byte> into) {
    std::byte* out = into.data();
    const size_t rowBytes = plane.rowBytes(), words = wordsOfRow(rowBytes);
    for (int32_t y = 0; y < plane.height && plane.width > 0; ++y) {
        const std::byte* row = plane.row(y);
        size_t literals = 0; // unwritten words before `at`
        const auto flush = [&](size_t at) {
            if (literals == 0) return;
            storeLittle(out, static_cast<uint32_t>(literals));
            out += 4;
            for (size_t i = at - literals; i < at; ++i, out += 8) storeLittle(out, wordAt(row, rowBytes, i));
            literals = 0;
        };
        for (size_t at = 0; at < words;) {
            const uint64_t word = wordAt(row, rowBytes, at);
            size_t end = at + 1;
            while (end < words && wordAt(row, rowBytes, end) == word) ++end;
            if (end - at < kShortestWords) {
                literals += end - at;
                at = end;
                continue;
            }
            flush(at);
            storeLittle(out, kRun | static_cast<uint32_t>(end - at));
            storeLittle(out + 4, word);
            out += 12;
            at = end;
        }
        flush(words);
    }
    return static_cast<size_t>(out - into.data());
}

Result<void> Rle64Codec::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    const auto damaged = [&](const char* what) { return damagedPlane("rle64", into, bytes.size(), what); };
    const size_t rowBytes = into.rowBytes(), words = wordsOfRow(rowBytes);
    std::span<const std::byte> left = bytes;
    for (int32_t y = 0; y < into.height && into.width > 0; ++y) {
        std::byte* row = into.row(y);
        for (size_t at = 0; at < words;) {
            if (left.size() < 12) return damaged("it is truncated");
            const uint32_t head = loadLittle<uint32_t>(left.data());
            const size_t count = head & ~kRun;
            if (count == 0 || count > words - at) return damaged("a run is longer than its row");
            left = left.subspan(4);
            if ((head & kRun) == 0 && left.size() < 8 * count) return damaged("it is truncated");
            const size_t step = head & kRun ? 0 : 8;
            for (size_t i = 0; i < count; ++i, ++at)
                std::memcpy(row + 8 * at, left.data() + step * i, std::min<size_t>(8, rowBytes - 8 * at));
            left = left.subspan(step ? 8 * count : 8);
        }
    }
    return left.empty() ? Result<void>() : damaged("there are bytes after its end");
}

} // namespace mural::compositor
