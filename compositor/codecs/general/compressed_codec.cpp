#include "compositor/codecs/general/compressed_codec.hpp"

#include "common/base/little_endian.hpp"

namespace mural::compositor {

namespace {

bool isTight(const PlaneView& p) { return p.strideBytes == static_cast<ptrdiff_t>(p.rowBytes()); }

} // namespace

size_t CompressedCodec::boundBytes(const PlaneShape& shape) const {
    if (shape.width <= 0 || shape.height <= 0) return 0;
    return inner_ ? 4 + compressor_->boundBytes(inner_->boundBytes(shape)) : compressor_->boundBytes(shape.sizeBytes());
}

Result<size_t> CompressedCodec::encode(const PlaneView& plane, std::span<std::byte> into) {
    if (plane.empty()) return size_t{0};
    std::span<const std::byte> bytes(plane.pixels, isTight(plane) ? plane.sizeBytes() : 0);
    size_t head = 0;
    if (inner_) {
        scratch_.resize(inner_->boundBytes(shapeOf(plane)));
        auto size = inner_->encode(plane, scratch_);
        if (!size) return size;
        bytes = std::span<const std::byte>(scratch_).first(*size);
        storeLittle(into.data(), static_cast<uint32_t>(*size));
        head = 4;
    } else if (!isTight(plane)) {
        scratch_.resize(plane.sizeBytes());
        copyPlane({plane.format, plane.width, plane.height, static_cast<ptrdiff_t>(plane.rowBytes()), scratch_.data()},
                  plane);
        bytes = scratch_;
    }
    const size_t size = compressor_->compress(bytes, into.subspan(head));
    if (size == 0)
        return Error{"codec " + name_ + ": " + std::to_string(bytes.size()) +
                     " bytes cannot be compressed: they are too many, or memory is short; use smaller pictures or "
                     "another codec"};
    return head + size;
}

Result<void> CompressedCodec::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    const auto damaged = [&](const char* what) { return damagedPlane(name_, into, bytes.size(), what); };
    if (into.empty()) return bytes.empty() ? Result<void>() : damaged("an empty plane has no bytes");
    if (inner_) {
        if (bytes.size() < 4) return damaged("its size is missing");
        const size_t size = loadLittle<uint32_t>(bytes.data());
        if (size > inner_->boundBytes(shapeOf(into))) return damaged("its size exceeds the maximum");
        scratch_.resize(size);
        if (!compressor_->decompress(bytes.subspan(4), scratch_)) return damaged("it cannot be decompressed");
        return inner_->decode(scratch_, into);
    }
    if (isTight(into))
        return compressor_->decompress(bytes, {into.pixels, into.sizeBytes()}) ? Result<void>()
                                                                               : damaged("it cannot be decompressed");
    scratch_.resize(into.sizeBytes());
    if (!compressor_->decompress(bytes, scratch_)) return damaged("it cannot be decompressed");
    copyPlane(into, {into.format, into.width, into.height, static_cast<ptrdiff_t>(into.rowBytes()), scratch_.data()});
    return {};
}

} // namespace mural::compositor
