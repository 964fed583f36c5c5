#include "compositor/codecs/lossy/jpeg_codec.hpp"

#include <turbojpeg.h>

#include "common/base/little_endian.hpp"

namespace mural::compositor {

// A size of 4 bytes, JPEG data, alpha.

JpegCodec::JpegCodec(int quality, bool halfColour)
    : quality_(quality),
      subsampling_(halfColour ? TJSAMP_420 : TJSAMP_444),
      compressor_(tjInitCompress()),
      decompressor_(tjInitDecompress()) {}

JpegCodec::~JpegCodec() {
    if (compressor_) tjDestroy(compressor_);
    if (decompressor_) tjDestroy(decompressor_);
}

size_t JpegCodec::boundBytes(const PlaneShape& shape) const {
    if (shape.width <= 0 || shape.height <= 0) return 0;
    return 4 + tjBufSize(shape.width, shape.height, subsampling_) + alpha_.boundBytes(shape);
}

Result<size_t> JpegCodec::encode(const PlaneView& plane, std::span<std::byte> into) {
    if (plane.empty()) return size_t{0};
    const auto failed = [&](const char* why) {
        return Error{"codec jpeg: a plane of " + std::to_string(plane.width) + "x" + std::to_string(plane.height) +
                     " cannot be encoded: " + why + "; use another codec"};
    };
    if (!compressor_) return failed("no memory");
    auto* to = reinterpret_cast<unsigned char*>(into.data() + 4);
    unsigned long size = tjBufSize(plane.width, plane.height, subsampling_);
    if (tjCompress2(compressor_, reinterpret_cast<const unsigned char*>(plane.pixels), plane.width,
                    static_cast<int>(plane.strideBytes), plane.height, TJPF_RGBA, &to, &size, subsampling_, quality_,
                    TJFLAG_NOREALLOC) != 0)
        return failed(tjGetErrorStr2(compressor_));
    storeLittle(into.data(), static_cast<uint32_t>(size));
    const size_t alpha = alpha_.encode(plane, into.subspan(4 + size));
    if (alpha == 0) return failed("no memory for its alpha");
    return 4 + size + alpha;
}

Result<void> JpegCodec::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    const auto damaged = [&](const char* what) { return damagedPlane("jpeg", into, bytes.size(), what); };
    if (into.empty()) return bytes.empty() ? Result<void>() : damaged("an empty plane has no bytes");
    if (into.format != PlaneFormat::Rgba8) return damaged("only RGBA8 is supported");
    if (bytes.size() < 4) return damaged("its size is missing");
    const size_t size = loadLittle<uint32_t>(bytes.data());
    if (size > bytes.size() - 4) return damaged("it is truncated");
    const auto* jpeg = reinterpret_cast<const unsigned char*>(bytes.data() + 4);
    int width = 0, height = 0, subsampling = 0, colours = 0;
    if (!decompressor_ || tjDecompressHeader3(decompressor_, jpeg, size, &width, &height, &subsampling, &colours) != 0)
        return damaged("it is not a JPEG picture");
    if (width != into.width || height != into.height) return damaged("it has another size");
    // Damaged data decodes with a warning, which counts as an error.
    if (tjDecompress2(decompressor_, jpeg, size, reinterpret_cast<unsigned char*>(into.pixels), into.width,
                      static_cast<int>(into.strideBytes), into.height, TJPF_RGBA, TJFLAG_LIMITSCANS) != 0)
        return damaged(tjGetErrorStr2(decompressor_));
    const size_t alpha = alpha_.decode(bytes.subspan(4 + size), into);
    return alpha != 0 && 4 + size + alpha == bytes.size() ? Result<void>() : damaged("its alpha is invalid");
}

} // namespace mural::compositor
