#include "nodes/output/jpeg_picture.hpp"

#include <memory>
#include <turbojpeg.h>

namespace mural {

namespace {

struct EndTurboJpeg {
    void operator()(void* handle) const { tjDestroy(handle); }
};
using TurboJpeg = std::unique_ptr<void, EndTurboJpeg>;

} // namespace

std::vector<std::byte> jpegOf(const Picture& picture, int quality) {
    const TurboJpeg handle(tjInitCompress());
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    const int done = handle == nullptr
                         ? -1
                         : tjCompress2(handle.get(), reinterpret_cast<const unsigned char*>(picture.bgra),
                                       picture.width, static_cast<int>(picture.rowBytes()), picture.height, TJPF_BGRX,
                                       &bytes, &size, TJSAMP_444, quality, TJFLAG_BOTTOMUP | TJFLAG_FASTDCT);
    std::vector<std::byte> jpeg;
    const auto* first = reinterpret_cast<const std::byte*>(bytes);
    if (done == 0) jpeg.assign(first, first + size);
    tjFree(bytes);
    return jpeg;
}

bool pictureOfJpeg(std::span<const std::byte> jpeg, int width, int height, OwnedPicture& into) {
    const TurboJpeg handle(tjInitDecompress());
    const auto* bytes = reinterpret_cast<const unsigned char*>(jpeg.data());
    int foundWidth = 0, foundHeight = 0, sampling = 0, colours = 0;
    if (handle == nullptr ||
        tjDecompressHeader3(handle.get(), bytes, jpeg.size(), &foundWidth, &foundHeight, &sampling, &colours) != 0)
        return false;
    if (foundWidth != width || foundHeight != height) return false;
    into.resize(width, height);
    return tjDecompress2(handle.get(), bytes, jpeg.size(), reinterpret_cast<unsigned char*>(into.data()), width,
                         static_cast<int>(into.rowBytes()), height, TJPF_BGRA, TJFLAG_BOTTOMUP) == 0;
}

} // namespace mural
