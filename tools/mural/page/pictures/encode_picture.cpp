#include "tools/mural/page/pictures/encode_picture.hpp"

#include <algorithm>
#include <memory>
#include <png.h>
#include <turbojpeg.h>

namespace mural::page {

namespace {

struct EndCompressor {
    void operator()(void* handle) const { tjDestroy(handle); }
};
struct FreeJpeg {
    void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

// A compressor is 500 kB of state, so each thread keeps one.
void* compressor() {
    thread_local const std::unique_ptr<void, EndCompressor> handle(tjInitCompress());
    return handle.get();
}

// rows: from the top, without gaps.
Result<std::string> pngOf(const std::string& rows, int width, int height, png_uint_32 format) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = format;
    image.flags = PNG_IMAGE_FLAG_FAST;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rows.data(), 0, nullptr) == 0)
        return Error{std::string("libpng cannot encode the picture: ") + image.message};
    bytes.resize(size);
    return bytes;
}

} // namespace

Result<std::string> encodeJpeg(const Picture& picture, int quality, ChromaOf chroma) {
    void* handle = compressor();
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    const int done =
        handle == nullptr
            ? -1
            : tjCompress2(handle, reinterpret_cast<const unsigned char*>(picture.bgra), picture.width,
                          static_cast<int>(picture.rowBytes()), picture.height, TJPF_BGRX, &bytes, &size,
                          chroma == ChromaOf::All ? TJSAMP_444 : TJSAMP_420, quality, TJFLAG_BOTTOMUP | TJFLAG_FASTDCT);
    const std::unique_ptr<unsigned char, FreeJpeg> owner(bytes);
    if (done != 0) return Error{std::string("libjpeg-turbo cannot encode the picture: ") + tjGetErrorStr2(handle)};
    return std::string(reinterpret_cast<const char*>(bytes), size);
}

Result<std::string> encodePng(const Picture& picture) {
    // The simplified interface of libpng has no format that skips alpha, so the rows are copied without it.
    constexpr size_t kRgb = 3;
    std::string rgb(static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height) * kRgb, '\0');
    char* to = rgb.data();
    for (int y = picture.height - 1; y >= 0; --y) {
        const auto* from = reinterpret_cast<const char*>(picture.row(y));
        for (int x = 0; x < picture.width; ++x, from += kPictureBytesPerPixel) {
            *to++ = from[2];
            *to++ = from[1];
            *to++ = from[0];
        }
    }
    return pngOf(rgb, picture.width, picture.height, PNG_FORMAT_RGB);
}

Result<std::string> encodeCursorPng(const uint32_t* pixels, int width, int height) {
    constexpr uint32_t kByte = 0xff;
    std::string rgba;
    for (int i = 0; i < width * height; ++i) {
        const uint32_t alpha = pixels[i] >> 24;
        for (const int shift : {16, 8, 0}) {
            const uint32_t colour = (pixels[i] >> shift) & kByte;
            rgba.push_back(static_cast<char>(alpha == 0 ? 0 : std::min(kByte, (colour * kByte + alpha / 2) / alpha)));
        }
        rgba.push_back(static_cast<char>(alpha));
    }
    return pngOf(rgba, width, height, PNG_FORMAT_RGBA);
}

} // namespace mural::page
