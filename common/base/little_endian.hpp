// Integers in bytes for other machines: little-endian, at any alignment.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstring>

namespace mural {

template <std::unsigned_integral T> T loadLittle(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    if constexpr (std::endian::native == std::endian::big) {
        T turned = 0;
        for (size_t i = 0; i < sizeof value; ++i) turned = static_cast<T>(turned << 8 | (value >> (8 * i) & 0xff));
        return turned;
    }
    return value;
}

template <std::unsigned_integral T> void storeLittle(std::byte* at, T value) {
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(at, &value, sizeof value); // compilers do not merge the loop into a single store
    } else {
        for (size_t i = 0; i < sizeof value; ++i) at[i] = static_cast<std::byte>(value >> (8 * i) & 0xff);
    }
}

} // namespace mural
