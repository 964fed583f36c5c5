// Vectorized difference filter for pixels. A piece has kPageBytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "streamcodec/delta/limits.hpp"
#include "streamcodec/delta/entropy/pixel_filters.hpp"

namespace mural::delta {

constexpr size_t kPieceWords = kPageBytes / 4, kPieceMaskBytes = kPieceWords / 8;
constexpr size_t kPieceWordRoom = kPieceWords + 16; // words that differences() may write

// Number of bytes of a piece that are sampled to estimate its bits for each of kPixelFilters.
constexpr size_t kSampledBytes = 256;
using Roughness = std::array<uint32_t, kPixelFilters.size()>;
Roughness roughness(const std::byte* piece);

// Writes the non-zero difference words and a bit per word; returns the number of words. `words`: room for
// kPieceWordRoom. `pixelBytes`: distance in bytes to the reference byte: 1, 2, 3, 4 or 8.
size_t differences(const std::byte* piece, size_t pixelBytes, uint32_t* words, std::byte* mask);

// Restores the piece and returns the number of words used. `words`: one per bit of the mask, and room for one more.
size_t sumDifferences(const uint32_t* words, const std::byte* mask, size_t pixelBytes, std::byte* piece);

// Writes the first bytes of all words, then the second bytes, and so on. `planes` has the size of the words.
void toPlanes(const uint32_t* words, size_t count, std::byte* planes);
void fromPlanes(const std::byte* planes, size_t count, uint32_t* words);

} // namespace mural::delta
