// The pixel filters of a piece of kPageBytes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::delta {

// Values up to 8: distance in bytes to the reference byte (0: unfiltered), for pixels of that size, samples of 16 bits,
// or alternating pairs of pixels. Larger values add green subtraction (green_subtraction.hpp).
// plus the number of bytes before the first whole pixel: 0, 1, 2
constexpr uint8_t kColoursOfFour = 16, kColoursOfThree = 17;
constexpr std::array<uint8_t, 10> kPixelFilters{
    0, 1, 2, 3, 4, 8, kColoursOfFour, kColoursOfThree, kColoursOfThree + 1, kColoursOfThree + 2};
constexpr size_t kByteFilters = 6; // filters without green subtraction

[[nodiscard]] constexpr bool isPixelFilter(uint8_t filter) {
    return std::ranges::find(kPixelFilters, filter) != kPixelFilters.end();
}

[[nodiscard]] constexpr bool takesColoursApart(uint8_t filter) { return filter >= kColoursOfFour; }

// Returns the reference distance after green subtraction: pixels of four bytes keep their order, pixels of three become
// colour planes.
[[nodiscard]] constexpr size_t pixelBytesOf(uint8_t filter) {
    return !takesColoursApart(filter) ? filter : filter == kColoursOfFour ? 4 : 1;
}

} // namespace mural::delta
