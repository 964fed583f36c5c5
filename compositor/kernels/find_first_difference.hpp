// Finds the end of background in a row, the inner loop of region-of-interest detection.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::compositor {

// Returns the first i with (words[i] ^ pattern[i % 4]) & mask[i % 4] != 0, or count. Pixels have one, two or four
// words, so four words are a whole number of pixels.
size_t findFirstDifference(const uint32_t* words, size_t count, const uint32_t pattern[4], const uint32_t mask[4]);
size_t findUnlikeScalar(const uint32_t* words, size_t count, const uint32_t pattern[4], const uint32_t mask[4]);

} // namespace mural::compositor
