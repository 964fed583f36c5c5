// The memory for pointer arguments: at the same address in each run, larger than any call may touch.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/random_gl/random.hpp"
#include "tests/fuzz/random_gl/tables.hpp"

namespace fuzz {

// Returns memory that calls read. Its values never change and suit `type`.
const void* inputOf(Type type, Random& random);
// Returns numbers below 48 for elements, with readable memory before and after them.
const void* indexMemory(Random& random, std::uint32_t typeEnum);
// Returns vertices: floats mostly between -1 and 1, with 64 KiB of readable memory before and after them.
const void* vertexMemory(Random& random);
// Returns a string: names in the programs of the pool, and others.
const char* text(Random& random);

// Size of the memory that calls write; it holds the same bytes before each call.
constexpr std::size_t kOutputBytes = 1 << 20;
void* outputMemory(std::size_t bytes); // resets the first `bytes`
// Returns memory for feedback and selection, which GL writes later.
void* lateMemory(std::size_t bytes);

std::uint64_t digest(const void* bytes, std::size_t count, std::uint64_t before = 0);

} // namespace fuzz
