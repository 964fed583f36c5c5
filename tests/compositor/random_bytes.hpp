// Random words and bytes biased towards difficult values: extremes, runs, equal numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/common/vector_targets.hpp"

namespace mural::compositor::test {

using mural::test::forEachTarget;

template <class Bytes> void fillRandomly(std::mt19937& random, Bytes& bytes) {
    for (auto& b : bytes) {
        const uint32_t kind = random() % 8;
        b = static_cast<std::byte>(kind == 0 ? 0 : kind == 1 ? 255 : random());
    }
}

inline std::vector<std::byte> randomBytes(std::mt19937& random, size_t count) {
    std::vector<std::byte> bytes(count);
    fillRandomly(random, bytes);
    return bytes;
}

} // namespace mural::compositor::test
