#include "compositor/codecs/lossy/alpha_plane.hpp"

#include <algorithm>

#include "common/base/little_endian.hpp"

namespace mural::compositor {

namespace {

// A kind, then the uniform value, or a size of 4 bytes and LZ4 data.
constexpr std::byte kUniform{0}, kCompressed{1};
size_t pixelsOf(const PlaneView& p) { return static_cast<size_t>(p.width) * static_cast<size_t>(p.height); }

} // namespace

size_t AlphaPlane::boundBytes(const PlaneShape& shape) const {
    return 5 + compressor_->boundBytes(shape.sizeBytes() / 4);
}

size_t AlphaPlane::encode(const PlaneView& plane, std::span<std::byte> into) {
    scratch_.resize(pixelsOf(plane));
    std::byte* to = scratch_.data();
    for (int32_t y = 0; y < plane.height; ++y)
        for (size_t at = 3; at < plane.rowBytes(); at += 4) *to++ = plane.row(y)[at];
    if (std::ranges::count(scratch_, scratch_[0]) == std::ssize(scratch_)) {
        into[0] = kUniform;
        into[1] = scratch_[0];
        return 2;
    }
    const size_t size = compressor_->compress(scratch_, into.subspan(5));
    if (size == 0) return 0;
    into[0] = kCompressed;
    storeLittle(into.data() + 1, static_cast<uint32_t>(size));
    return 5 + size;
}

size_t AlphaPlane::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    if (bytes.size() < 2) return 0;
    size_t taken = 2;
    scratch_.assign(pixelsOf(into), bytes[1]);
    if (bytes[0] == kCompressed) {
        if (bytes.size() < 5) return 0;
        const size_t size = loadLittle<uint32_t>(bytes.data() + 1);
        if (size > bytes.size() - 5 || !compressor_->decompress(bytes.subspan(5, size), scratch_)) return 0;
        taken = 5 + size;
    } else if (bytes[0] != kUniform) {
        return 0;
    }
    const std::byte* from = scratch_.data();
    for (int32_t y = 0; y < into.height; ++y)
        for (size_t at = 3; at < into.rowBytes(); at += 4) into.row(y)[at] = *from++;
    return taken;
}

} // namespace mural::compositor
