// Ways to tell a piece of kPageBytes as changes from pixel to pixel.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::economy {

// Up to 8: how far back the byte is that each one is compared with (0: none). So many bytes pixels have, or samples of 16 bits, or pairs of
// pixels that take turns. Above, red and blue go as what they differ from green by (pixel_colours.hpp).
constexpr uint8_t kColoursOfFour = 16, kColoursOfThree = 17; // the latter, and how many bytes stand before the first whole pixel: 0, 1, 2
constexpr std::array<uint8_t, 10> kPixelWays{0, 1, 2, 3, 4, 8, kColoursOfFour, kColoursOfThree, kColoursOfThree + 1, kColoursOfThree + 2};
constexpr size_t kPlainWays = 6; // that leave colours as they are

[[nodiscard]] constexpr bool isPixelWay(uint8_t way) { return std::ranges::find(kPixelWays, way) != kPixelWays.end(); }

[[nodiscard]] constexpr bool takesColoursApart(uint8_t way) { return way >= kColoursOfFour; }

// Once colours were taken apart: pixels of four stay where they are, of those of three each colour stands together.
[[nodiscard]] constexpr size_t pixelBytesOf(uint8_t way) { return !takesColoursApart(way) ? way : way == kColoursOfFour ? 4 : 1; }

} // namespace mural::economy
