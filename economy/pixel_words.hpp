// Bytes of pixels as what changes from one to the next, by vectors. A piece has kPageBytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "economy/limits.hpp"
#include "economy/pixel_ways.hpp"

namespace mural::economy {

constexpr size_t kPieceWords = kPageBytes / 4, kPieceMaskBytes = kPieceWords / 8;
constexpr size_t kPieceWordRoom = kPieceWords + 16; // that differences() may write

// About how many bits so many of a piece's bytes have, by each of kPixelWays.
constexpr size_t kSampledBytes = 256;
using Roughness = std::array<uint32_t, kPixelWays.size()>;
Roughness roughness(const std::byte* piece);

// Its words that are not 0 as differences, and of each word a bit whether it is one of them. How many they are. `words`: kPieceWordRoom;
// `pixelBytes`: how far back the byte is that each one is compared with: 1, 2, 3, 4 or 8.
size_t differences(const std::byte* piece, size_t pixelBytes, uint32_t* words, std::byte* mask);

// The piece again. `words`: as many as the mask has bits, which is what it returns, and room for one more.
size_t sumDifferences(const uint32_t* words, const std::byte* mask, size_t pixelBytes, std::byte* piece);

// First bytes of all words, then all second ones …: `planes` has as many bytes as the words.
void toPlanes(const uint32_t* words, size_t count, std::byte* planes);
void fromPlanes(const std::byte* planes, size_t count, uint32_t* words);

} // namespace mural::economy
