// Limits of the fuzzed decoder and of the encoder that makes its corpus. They are so small that all memory is soon
// overwritten.
#pragma once

#include "streamcodec/delta/limits.hpp"

namespace mural::fuzz {

inline delta::Limits fuzzLimits() {
    return {.cacheBytes = 4 * delta::kPageBytes, .textBytes = 4096, .logItems = 64, .streams = 2, .modelWords = 1024};
}

} // namespace mural::fuzz
