// Filters new pages that contain pictures, in pieces of 4 KiB. Neighbouring pixels differ little, so words become
// differences, optionally after green subtraction; zero words become one bit, the others are split into byte planes.
// Zstandard then needs a quarter fewer bytes in two thirds of the time. (PNG filters and QOI runs are similar.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "streamcodec/delta/limits.hpp"

namespace mural::delta {

// Returns an estimate of the piece's size after filtering.
[[nodiscard]] size_t leftOfPixels(const std::byte* piece);

class PixelFilterEncoder {
public:
    // Splits the pages. Returns false if filtering gains nothing; then there are no parts. Parts are valid until the
    // next call.
    bool split(std::span<const std::byte> pages);

    // Per piece its filter (kPixelFilters; 0: none), then the zero bits of each filtered piece.
    [[nodiscard]] std::span<const std::byte> front() const { return front_; }
    [[nodiscard]] size_t pixelPieces() const { return pixelPieces_; }
    [[nodiscard]] std::span<const std::byte> planes() const { return std::span(planes_).first(planeBytes_); }
    // Unfiltered pieces, and the bytes after the last piece.
    [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

private:
    [[nodiscard]] bool repeats(std::span<const std::byte> pages);
    void takeApart(std::span<const std::byte> pages, std::span<const uint8_t> filters);

    std::vector<uint8_t> filters_;
    std::vector<std::byte> front_, planes_, rest_, scratch_;
    std::vector<uint32_t> words_;
    size_t pixelPieces_ = 0, planeBytes_ = 0;
};

[[nodiscard]] size_t frontBytes(size_t pagesBytes, size_t pixelPieces);
class PixelFilterDecoder {
public:
    // Returns false if the front is malformed for this size. The front must stay valid until join() returns.
    bool begin(std::span<const std::byte> front, size_t pagesBytes, size_t pixelPieces);
    [[nodiscard]] size_t planeBytes() const { return planeBytes_; }
    [[nodiscard]] size_t restBytes() const { return pagesBytes_ - pixelPieces_ * kPageBytes; }
    // Restores the pages. Requires the sizes given to begin(), planeBytes() and restBytes().
    void join(std::span<const std::byte> planes, std::span<const std::byte> rest, std::span<std::byte> pages);

private:
    std::span<const std::byte> filters_, masks_;
    std::vector<uint32_t> words_;
    size_t pagesBytes_ = 0, pixelPieces_ = 0, planeBytes_ = 0;
};

} // namespace mural::delta
