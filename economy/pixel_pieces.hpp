// New pages in pieces of 4 KiB, of which some are like pictures: little changes from one pixel to the next, and most is in the low bits. Their
// words go as differences, of colours besides what they do not have in common, those that are 0 as a bit, the others with their bytes in planes:
// so Zstandard finds a quarter fewer bytes in two thirds of the time, where it had looked for pixels that came before. (Formats of pictures do
// as much: PNG's filters, QOI's runs.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "economy/limits.hpp"

namespace mural::economy {

// What is left of a piece's bytes as differences, about.
[[nodiscard]] size_t leftOfPixels(const std::byte* piece);

class PixelSplitter {
public:
    // False: nothing is to be won, so there are no parts. They live until the next call.
    bool split(std::span<const std::byte> pages);

    // Of each piece its way (kPixelWays; 0: it is no picture), then of each one with pixels the bits.
    [[nodiscard]] std::span<const std::byte> front() const { return front_; }
    [[nodiscard]] size_t pixelPieces() const { return pixelPieces_; }
    [[nodiscard]] std::span<const std::byte> planes() const { return std::span(planes_).first(planeBytes_); }
    // Pieces that are none, and what is left behind the last.
    [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

private:
    [[nodiscard]] bool repeats(std::span<const std::byte> pages);
    void takeApart(std::span<const std::byte> pages, std::span<const uint8_t> ways);

    std::vector<uint8_t> ways_;
    std::vector<std::byte> front_, planes_, rest_, scratch_;
    std::vector<uint32_t> words_;
    size_t pixelPieces_ = 0, planeBytes_ = 0;
};

[[nodiscard]] size_t frontBytes(size_t pagesBytes, size_t pixelPieces);
class PixelJoiner {
public:
    // False: this is no front of so many pages. The front must live until join() is done.
    bool begin(std::span<const std::byte> front, size_t pagesBytes, size_t pixelPieces);
    [[nodiscard]] size_t planeBytes() const { return planeBytes_; }
    [[nodiscard]] size_t restBytes() const { return pagesBytes_ - pixelPieces_ * kPageBytes; }
    // `pages` has the bytes that begin() was told, the parts as many as planeBytes() and restBytes() say.
    void join(std::span<const std::byte> planes, std::span<const std::byte> rest, std::span<std::byte> pages);

private:
    std::span<const std::byte> ways_, masks_;
    std::vector<uint32_t> words_;
    size_t pagesBytes_ = 0, pixelPieces_ = 0, planeBytes_ = 0;
};

} // namespace mural::economy
