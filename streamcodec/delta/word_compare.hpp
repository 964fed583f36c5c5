// Comparisons of records and runs. Sizes are multiples of 4 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mural::delta {

// Compares words inline. Most entries are too short for a call of memcmp to pay off.
inline bool sameWords(const std::byte* a, const std::byte* b, size_t sizeBytes) {
    if (sizeBytes > 64) return std::memcmp(a, b, sizeBytes) == 0;
    for (; sizeBytes >= 8; sizeBytes -= 8, a += 8, b += 8) {
        uint64_t wordsOfA = 0, wordsOfB = 0;
        std::memcpy(&wordsOfA, a, 8);
        std::memcpy(&wordsOfB, b, 8);
        if (wordsOfA != wordsOfB) return false;
    }
    return sizeBytes == 0 || std::memcmp(a, b, 4) == 0;
}

// Returns the length of the common prefix in whole words.
inline size_t equalBytes(const std::byte* a, const std::byte* b, size_t sizeBytes) {
    constexpr size_t kBlock = 1024; // memcmp is fast but does not return the position
    size_t at = 0;
    while (sizeBytes - at >= kBlock && std::memcmp(a + at, b + at, kBlock) == 0) at += kBlock;
    for (; sizeBytes - at >= 8; at += 8) {
        uint64_t wordsOfA = 0, wordsOfB = 0;
        std::memcpy(&wordsOfA, a + at, 8);
        std::memcpy(&wordsOfB, b + at, 8);
        if (wordsOfA != wordsOfB) break;
    }
    return at < sizeBytes && std::memcmp(a + at, b + at, 4) == 0 ? at + 4 : at;
}

} // namespace mural::delta
