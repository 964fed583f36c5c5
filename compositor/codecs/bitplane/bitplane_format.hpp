// The bit-plane code of a strip: 4 rows of up to 256 words, as blocks of 16 x 4 words. docs/compositing.md has the whole format.
//
// A word is a pixel of 4 bytes, or a part of a larger one. Each is predicted from the rows above it; what is left of the four
// bytes ("channels") of a block's words is written with as many bits as the largest of the channel needs. All of it is
// whole-vector work in any width, and prediction, packing and layout are the same bits on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compositor/image/plane_format.hpp"

namespace mural::compositor::bitplane {

constexpr unsigned kBlockColumns = 16; // words
constexpr unsigned kStripRows = 4;
constexpr unsigned kChannelBytes = kBlockColumns * kStripRows; // byte 4 * column + row
constexpr unsigned kBlockBytes = 4 * kChannelBytes;
constexpr unsigned kMostBlocks = 16;
constexpr unsigned kTileColumns = kMostBlocks * kBlockColumns;
constexpr unsigned kTileRows = 64;
constexpr size_t kStripHeadBytes = 2; // which blocks are not all zero
constexpr size_t kStripBoundBytes = kStripHeadBytes + kMostBlocks * (2 + kBlockBytes);
// Packing writes, and unpacking reads, this much beyond what it needs.
constexpr size_t kSlackBytes = 64;

// Of what differences are taken.
enum class Arithmetic : uint8_t {
    Bytes,        // RGBA8; red and blue are then less green
    Halves,       // RGBA16F
    Words,        // D32F, RGB10A2, RGBA32F
    RotatedWords, // D24S8: depth below, the stencil, which seldom changes, above
};
[[nodiscard]] constexpr Arithmetic arithmeticOf(PlaneFormat f) {
    if (f == PlaneFormat::Rgba8) return Arithmetic::Bytes;
    if (f == PlaneFormat::Rgba16F) return Arithmetic::Halves;
    return f == PlaneFormat::D24S8 ? Arithmetic::RotatedWords : Arithmetic::Words;
}

enum class Predictor : uint8_t {
    Above = 0, // the word above
    Slope = 1, // the word above and its difference to the one above it: planes of depth
};

struct StripKind {
    Arithmetic arithmetic = Arithmetic::Bytes;
    Predictor predictor = Predictor::Above;
    bool first = false; // nothing is above: above() of its row 0 is given by the caller, and its row 1 has no slope yet
};

struct StripSource {
    const std::byte* rows = nullptr; // row 0
    ptrdiff_t strideBytes = 0;
    const std::byte* above = nullptr;
    const std::byte* above2 = nullptr; // for Slope; not read in the first strip
    unsigned blocks = 0;
};

// A strip that was read: sizes are checked, kSlackBytes behind the payload may be read.
struct ParsedStrip {
    uint32_t present = 0; // a bit for each block
    std::array<uint16_t, kMostBlocks> widths{}; // of the present ones, in their order: 4 bits for each channel
    const std::byte* payload = nullptr;
};

struct StripTarget {
    std::byte* rows = nullptr;
    ptrdiff_t strideBytes = 0;
    const std::byte* above = nullptr;
    const std::byte* above2 = nullptr;
    unsigned blocks = 0;
};

// Of four blocks' widths. A channel of `width` bits takes 8 * width bytes.
[[nodiscard]] constexpr size_t payloadBytes(uint64_t widths) {
    const uint64_t pairs = (widths & 0x0f0f0f0f0f0f0f0f) + (widths >> 4 & 0x0f0f0f0f0f0f0f0f);
    const uint64_t blocks = (pairs & 0x00ff00ff00ff00ff) + (pairs >> 8 & 0x00ff00ff00ff00ff);
    return 8 * static_cast<size_t>(blocks * 0x0001000100010001 >> 48);
}
// A width is 0 to 8.
[[nodiscard]] constexpr bool validWidths(uint64_t widths) {
    const uint64_t eights = widths & 0x8888888888888888;
    return (widths & (eights >> 1 | eights >> 2 | eights >> 3)) == 0;
}

// Takes head and widths apart; kSlackBytes behind the bytes may be read. Returns the bytes that the strip takes, or 0 if it is
// cut short or no strip.
[[nodiscard]] size_t parseStrip(std::span<const std::byte> bytes, unsigned blocks, ParsedStrip& into);

} // namespace mural::compositor::bitplane
