// How an X server stores the pixels of a window, and turning our pixels into that. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/result.hpp"

namespace mural {

struct PixelFormat {
    int depth = 24;        // bits that mean something
    int bitsPerPixel = 32; // bits that are stored
    int rowPadBits = 32;   // rows begin on multiples of this
    uint32_t redMask = 0xff0000;
    uint32_t greenMask = 0x00ff00;
    uint32_t blueMask = 0x0000ff;
};

class PixelConverter {
public:
    // Fails for formats that have no red, green and blue, or pixels that are no whole bytes.
    static Result<PixelConverter> make(const PixelFormat& format);

    [[nodiscard]] size_t bytesPerPixel() const { return bytesPerPixel_; }
    [[nodiscard]] size_t rowBytes(int width) const; // with its padding
    [[nodiscard]] const PixelFormat& format() const { return format_; }

    // `bgra`: pixels as in Picture; writes pixels * bytesPerPixel() bytes, least significant byte
    // first.
    void convertRow(const std::byte* bgra, int pixels, std::byte* target) const;

private:
    PixelConverter() = default;

    template <size_t Bytes>
    void convertByTable(const std::byte* bgra, int pixels, std::byte* target) const;

    PixelFormat format_;
    size_t bytesPerPixel_ = 4;
    bool sameLayout_ = false; // B G R X in memory: nothing to convert but X
    uint32_t opaque_ = 0;     // bits of the depth that belong to no colour: the alpha of depth 32
    // What a channel's value contributes to the pixel: already scaled and at its place.
    std::array<uint32_t, 256> red_{}, green_{}, blue_{};
};

} // namespace mural
