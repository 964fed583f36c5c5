// The memory behind pointers: at the same address in each run, larger than any call may touch.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/random_gl/random.hpp"
#include "tests/fuzz/random_gl/tables.hpp"

namespace fuzz {

// What calls read: values that never change. `type` says what they are good for as.
const void* inputOf(Type type, Random& random);
// Numbers below 48, for elements; readable before and behind.
const void* indexMemory(Random& random, std::uint32_t typeEnum);
// Vertices: floats that are mostly between -1 and 1; 64 KiB before and behind can be read.
const void* vertexMemory(Random& random);
// Strings: names in the programs of the pool, and others.
const char* text(Random& random);

// What calls write: the same bytes before each call.
constexpr std::size_t kOutputBytes = 1 << 20;
void* outputMemory(std::size_t bytes); // the first bytes are made fresh
// Feedback and selection, which the GL writes later.
void* lateMemory(std::size_t bytes);

std::uint64_t digest(const void* bytes, std::size_t count, std::uint64_t before = 0);

} // namespace fuzz
