// Bit-plane code of a strip: 4 rows of up to 256 words, in blocks of 16 x 4 words. docs/reference/codecs.md describes
// the whole format.
//
// A word is a pixel of 4 bytes, or a part of a larger one. Each word is predicted from the rows above. Each byte of the
// residuals (a "channel") of a block is stored with as many bits as its largest value needs. All operations are
// vectorized with any vector width; prediction, packing and layout give equal bits on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compositor/image/plane_format.hpp"

namespace mural::compositor::bitplane {

constexpr unsigned kBlockColumns = 16; // in words
constexpr unsigned kStripRows = 4;
constexpr unsigned kChannelBytes = kBlockColumns * kStripRows; // at byte 4 * column + row
constexpr unsigned kBlockBytes = 4 * kChannelBytes;
constexpr unsigned kMaxBlocks = 16;
constexpr unsigned kTileColumns = kMaxBlocks * kBlockColumns;
constexpr unsigned kTileRows = 64;
constexpr size_t kStripHeadBytes = 2; // bit mask of non-zero blocks
constexpr size_t kStripBoundBytes = kStripHeadBytes + kMaxBlocks * (2 + kBlockBytes);
// Packing writes, and unpacking reads, up to this many bytes beyond the end.
constexpr size_t kSlackBytes = 64;

// Arithmetic of the differences.
enum class Arithmetic : uint8_t {
    Bytes,        // RGBA8; with green subtraction
    Halves,       // RGBA16F
    Words,        // D32F, RGB10A2, RGBA32F
    RotatedWords, // D24S8: depth in the low bits, the rarely changing stencil above
};
[[nodiscard]] constexpr Arithmetic arithmeticOf(PlaneFormat f) {
    if (f == PlaneFormat::Rgba8) return Arithmetic::Bytes;
    if (f == PlaneFormat::Rgba16F) return Arithmetic::Halves;
    return f == PlaneFormat::D24S8 ? Arithmetic::RotatedWords : Arithmetic::Words;
}

enum class Predictor : uint8_t {
    Above = 0, // the word above
    Slope = 1, // linear extrapolation from the two words above: depth planes
};

struct StripKind {
    Arithmetic arithmetic = Arithmetic::Bytes;
    Predictor predictor = Predictor::Above;
    bool first = false; // first strip of a tile: the caller provides above() of row 0, and row 1 has no slope yet
};

struct StripSource {
    const std::byte* rows = nullptr; // row 0
    ptrdiff_t strideBytes = 0;
    const std::byte* above = nullptr;
    const std::byte* above2 = nullptr; // for Slope; unused in the first strip
    unsigned blocks = 0;
};

// A parsed strip with validated sizes. kSlackBytes after the payload are readable.
struct ParsedStrip {
    uint32_t present = 0;                      // one bit per block
    std::array<uint16_t, kMaxBlocks> widths{}; // per non-zero block: 4 bits per channel
    const std::byte* payload = nullptr;
};

struct StripTarget {
    std::byte* rows = nullptr;
    ptrdiff_t strideBytes = 0;
    const std::byte* above = nullptr;
    const std::byte* above2 = nullptr;
    unsigned blocks = 0;
};

// Returns the payload size for the widths of four blocks. A channel of `width` bits takes 8 * width bytes.
[[nodiscard]] constexpr size_t payloadBytes(uint64_t widths) {
    const uint64_t pairs = (widths & 0x0f0f0f0f0f0f0f0f) + (widths >> 4 & 0x0f0f0f0f0f0f0f0f);
    const uint64_t blocks = (pairs & 0x00ff00ff00ff00ff) + (pairs >> 8 & 0x00ff00ff00ff00ff);
    return 8 * static_cast<size_t>(blocks * 0x0001000100010001 >> 48);
}
// Valid widths are 0 to 8.
[[nodiscard]] constexpr bool validWidths(uint64_t widths) {
    const uint64_t eights = widths & 0x8888888888888888;
    return (widths & (eights >> 1 | eights >> 2 | eights >> 3)) == 0;
}

// Parses head and widths. Requires kSlackBytes readable after `bytes`. Returns the size of the strip, or 0 if it is
// truncated or malformed.
[[nodiscard]] size_t parseStrip(std::span<const std::byte> bytes, unsigned blocks, ParsedStrip& into);

} // namespace mural::compositor::bitplane
