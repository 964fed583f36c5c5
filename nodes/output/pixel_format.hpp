// The pixel layout of an X window, and the conversion of pictures into it. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/picture_format.hpp"
#include "common/base/result.hpp"

namespace mural {

struct PixelFormat {
    int depth = 24;        // significant bits
    int bitsPerPixel = 32; // stored bits
    int rowPadBits = 32;   // rows start at multiples of this
    uint32_t redMask = 0xff0000;
    uint32_t greenMask = 0x00ff00;
    uint32_t blueMask = 0x0000ff;
};

class PixelConverter {
public:
    // Errors: a format without red, green and blue, or with pixels of a fraction of a byte.
    static Result<PixelConverter> make(const PixelFormat& format);

    [[nodiscard]] size_t bytesPerPixel() const { return bytesPerPixel_; }
    [[nodiscard]] size_t rowBytes(int width) const; // includes the padding
    [[nodiscard]] const PixelFormat& format() const { return format_; }

    // Reads `pixels` pixels of a Picture of that format; writes pixels * bytesPerPixel() bytes, least significant byte
    // first.
    void convertRow(PictureFormat format, const std::byte* source, int pixels, std::byte* target) const;

private:
    PixelConverter() = default;

    // The scaled and shifted contribution of each channel value to the pixel. A visual has no alpha mask: alpha takes
    // the bits of the depth outside the colour masks.
    struct Tables {
        int bits = 8; // per colour in the source word; blue is lowest, without gaps
        std::vector<uint32_t> blue, green, red, alpha;
    };
    [[nodiscard]] static Tables tablesOf(PictureFormat source, const PixelFormat& format, uint32_t alphaMask);
    template <size_t Bytes>
    static void convertByTable(const Tables& tables, const std::byte* source, int pixels, std::byte* target);

    PixelFormat format_;
    size_t bytesPerPixel_ = 4;
    std::array<bool, 2> sameLayout_{}; // by PictureFormat: rows are copied
    std::array<Tables, 2> tables_;     // by PictureFormat
};

} // namespace mural
