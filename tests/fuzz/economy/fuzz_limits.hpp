// Of the fuzzed unpacker and the packer that makes its corpus: so small that all of it is overwritten soon.
#pragma once

#include "economy/limits.hpp"

namespace mural::fuzz {

inline economy::Limits fuzzLimits() { return {.storeBytes = 4 * economy::kPageBytes, .textBytes = 4096, .logItems = 64, .streams = 2, .modelWords = 1024}; }

} // namespace mural::fuzz
