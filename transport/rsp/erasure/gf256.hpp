// The field GF(2^8) over x^8 + x^4 + x^3 + x^2 + 1, and the byte operation of the erasure code.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mural::rsp::gf256 {

namespace detail {
struct Tables {
    std::array<uint8_t, 512> power{}; // powers of the generator 2, doubled so that sums of logarithms need no modulus
    std::array<uint8_t, 256> logarithm{};
};
constexpr Tables makeTables() {
    Tables t;
    unsigned value = 1;
    for (unsigned i = 0; i < 255; ++i) {
        t.power[i] = t.power[i + 255] = static_cast<uint8_t>(value);
        t.logarithm[value] = static_cast<uint8_t>(i);
        value <<= 1;
        if (value & 0x100) value ^= 0x11d;
    }
    return t;
}
inline constexpr Tables kTables = makeTables();
} // namespace detail

constexpr uint8_t multiply(uint8_t a, uint8_t b) {
    if (a == 0 || b == 0) return 0;
    return detail::kTables.power[detail::kTables.logarithm[a] + detail::kTables.logarithm[b]];
}
// Requires a != 0.
constexpr uint8_t inverse(uint8_t a) { return detail::kTables.power[255 - detail::kTables.logarithm[a]]; }

// Computes into[i] ^= factor * from[i] for all of `from`, vectorized. Requires `into` to be at least as long.
void multiplyAdd(std::span<std::byte> into, std::span<const std::byte> from, uint8_t factor);
// Scalar reference implementation for tests.
void multiplyAddScalar(std::span<std::byte> into, std::span<const std::byte> from, uint8_t factor);

} // namespace mural::rsp::gf256
