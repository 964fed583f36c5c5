// Scalar operations of the bit-plane code: the reference for the vector code.
#pragma once

#include <bit>
#include <cstdint>

#include "compositor/codecs/bitplane/bitplane_format.hpp"

namespace mural::compositor::bitplane {

// Adds lanes of `bits` bits without carries between them.
template <unsigned kBits> constexpr uint32_t addLanes(uint32_t a, uint32_t b) {
    constexpr uint32_t high = kBits == 8 ? 0x80808080u : kBits == 16 ? 0x80008000u : 0x80000000u;
    return ((a & ~high) + (b & ~high)) ^ ((a ^ b) & high);
}
template <unsigned kBits> constexpr uint32_t subtractLanes(uint32_t a, uint32_t b) {
    constexpr uint32_t high = kBits == 8 ? 0x80808080u : kBits == 16 ? 0x80008000u : 0x80000000u;
    return ((a | high) - (b & ~high)) ^ ((a ^ ~b) & high);
}
constexpr uint32_t add(Arithmetic a, uint32_t x, uint32_t y) {
    return a == Arithmetic::Bytes ? addLanes<8>(x, y) : a == Arithmetic::Halves ? addLanes<16>(x, y) : x + y;
}
constexpr uint32_t subtract(Arithmetic a, uint32_t x, uint32_t y) {
    return a == Arithmetic::Bytes ? subtractLanes<8>(x, y) : a == Arithmetic::Halves ? subtractLanes<16>(x, y) : x - y;
}

// Zigzag mapping: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
template <class T> constexpr T folded(T value) {
    return static_cast<T>(static_cast<T>(value << 1) ^
                          static_cast<T>(0 - static_cast<T>(value >> (8 * sizeof(T) - 1))));
}
template <class T> constexpr T unfolded(T value) {
    return static_cast<T>(static_cast<T>(value >> 1) ^ static_cast<T>(0 - static_cast<T>(value & 1)));
}

// Rotates words before differences are taken, and back.
constexpr uint32_t turned(Arithmetic a, uint32_t word) {
    return a == Arithmetic::RotatedWords ? std::rotr(word, 8) : word;
}
constexpr uint32_t turnedBack(Arithmetic a, uint32_t word) {
    return a == Arithmetic::RotatedWords ? std::rotl(word, 8) : word;
}

// Returns the packed form of a difference: with green subtraction, and zigzag-mapped.
constexpr uint32_t residualOf(Arithmetic a, uint32_t d) {
    if (a == Arithmetic::Bytes) {
        const auto green = static_cast<uint8_t>(d >> 8);
        const auto red = folded(static_cast<uint8_t>(d - green)),
                   blue = folded(static_cast<uint8_t>((d >> 16) - green));
        return red | uint32_t{folded(green)} << 8 | uint32_t{blue} << 16 |
               uint32_t{folded(static_cast<uint8_t>(d >> 24))} << 24;
    }
    if (a == Arithmetic::Halves)
        return folded(static_cast<uint16_t>(d)) | uint32_t{folded(static_cast<uint16_t>(d >> 16))} << 16;
    return folded(d);
}
constexpr uint32_t differenceOf(Arithmetic a, uint32_t r) {
    if (a == Arithmetic::Bytes) {
        const auto green = unfolded(static_cast<uint8_t>(r >> 8));
        const auto red = static_cast<uint8_t>(unfolded(static_cast<uint8_t>(r)) + green),
                   blue = static_cast<uint8_t>(unfolded(static_cast<uint8_t>(r >> 16)) + green);
        return red | uint32_t{green} << 8 | uint32_t{blue} << 16 |
               uint32_t{unfolded(static_cast<uint8_t>(r >> 24))} << 24;
    }
    if (a == Arithmetic::Halves)
        return unfolded(static_cast<uint16_t>(r)) | uint32_t{unfolded(static_cast<uint16_t>(r >> 16))} << 16;
    return unfolded(r);
}

} // namespace mural::compositor::bitplane
