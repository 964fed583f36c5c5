// Componentwise sums of pictures and their rounded averages. RGBA8 sums in 16 bits while they fit (257 pictures).
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::compositor {

constexpr uint32_t kMaxIn16Bits = 257; // 257 * 255 = 65535
// Most pictures for which a float division rounds correctly: sum + n/2 stays below 2^24, and n below 2^17.
constexpr uint32_t kMaxAveraged8 = 65535;
constexpr uint32_t kMaxAveraged10 = 16384;

void addToSums(uint16_t* sums, const uint8_t* components, size_t count);
void addToSumsScalar(uint16_t* sums, const uint8_t* components, size_t count);

// Computes (sum + n/2) / n in integers: rounds to nearest, ties up. Requires n in 1 ... kMaxAveraged8 and no sum above
// 255 n.
void averageOfSums(uint8_t* components, const uint16_t* sums, size_t count, uint32_t n);
void averageOfSums(uint8_t* components, const uint32_t* sums, size_t count, uint32_t n);
void averageOfSumsScalar(uint8_t* components, const uint16_t* sums, size_t count, uint32_t n);
void averageOfSumsScalar(uint8_t* components, const uint32_t* sums, size_t count, uint32_t n);

} // namespace mural::compositor
