// The interface of a fuzz target: a function that takes one arbitrary input. fuzz_entry.cpp passes it to libFuzzer.
// fuzz_regression.cpp runs the corpus and mutations of it without libFuzzer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

namespace mural::fuzz {

// Returns the number of meaningful parts of the input: a corpus without any tests nothing.
uint64_t fuzzOne(std::span<const std::byte> input);

// Ends the process if a condition that every input must satisfy is false. Unlike assert, also in release builds.
inline void must(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "fuzz: this does not hold: %s\n", what);
    std::abort();
}

} // namespace mural::fuzz
