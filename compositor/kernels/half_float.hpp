// Conversions of half floats (IEEE 754 binary16) with integer operations: equal bits on every machine, which hardware
// conversions do not guarantee.
#pragma once

#include <bit>
#include <cstdint>

namespace mural::compositor {

[[nodiscard]] inline float floatOfHalf(uint16_t half) {
    const uint32_t sign = static_cast<uint32_t>(half & 0x8000) << 16;
    const uint32_t rest = static_cast<uint32_t>(half & 0x7fff) << 13;
    const uint32_t exponent = rest & (0x7c00u << 13);
    if (exponent == 0x7c00u << 13) return std::bit_cast<float>(sign | (rest + ((255u - 31u) << 23))); // infinity, NaN
    if (exponent != 0) return std::bit_cast<float>(sign | (rest + ((127u - 15u) << 23)));
    // Denormal: a multiple of 2^-24, normalised by a float subtraction.
    const float value = std::bit_cast<float>(rest + (113u << 23)) - std::bit_cast<float>(113u << 23);
    return std::bit_cast<float>(sign | std::bit_cast<uint32_t>(value));
}

// Rounds to the nearest half, ties to even; overflow gives infinity.
[[nodiscard]] inline uint16_t halfOfFloat(float value) {
    const uint32_t bits = std::bit_cast<uint32_t>(value);
    const uint32_t sign = bits >> 16 & 0x8000;
    const uint32_t rest = bits & 0x7fffffff;
    if (rest > 0x7f800000) return 0x7e00; // canonical NaN
    if (rest >= (127u + 16u) << 23) return static_cast<uint16_t>(sign | 0x7c00);
    if (rest < 113u << 23) { // denormal: the addition rounds
        const float scaled = std::bit_cast<float>(rest) + 0.5f;
        return static_cast<uint16_t>(sign | (std::bit_cast<uint32_t>(scaled) - 0x3f000000u));
    }
    const uint32_t odd = rest >> 13 & 1;
    return static_cast<uint16_t>(sign | (rest - ((127u - 15u) << 23) + 0xfff + odd) >> 13);
}

} // namespace mural::compositor
