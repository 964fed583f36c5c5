// Where a row stops being background: what finding regions of interest does all day.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::compositor {

// The first i for which (words[i] ^ pattern[i % 4]) & mask[i % 4] is not 0; count when there is none. A pixel of 4, 8 or 16
// bytes is one, two or four words, so a pattern of four is a whole number of pixels.
size_t findUnlike(const uint32_t* words, size_t count, const uint32_t pattern[4], const uint32_t mask[4]);
size_t findUnlikeScalar(const uint32_t* words, size_t count, const uint32_t pattern[4], const uint32_t mask[4]);

} // namespace mural::compositor
