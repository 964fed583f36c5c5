// What each fuzz target is: a function that takes one input, whatever it holds. fuzz_entry.cpp gives it to libFuzzer,
// fuzz_regression.cpp runs the corpus and changes to it where there is no libFuzzer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

namespace mural::fuzz {

// Returns how much of it meant something: a corpus of which nothing does tests nothing.
uint64_t fuzzOne(std::span<const std::byte> input);

// What must hold whatever comes in. Unlike assert, also in builds for release.
inline void must(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "fuzz: this does not hold: %s\n", what);
    std::abort();
}

} // namespace mural::fuzz
