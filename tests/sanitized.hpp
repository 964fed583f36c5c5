// Reduces the rounds of random tests under sanitizers, which are ten to fifty times slower. The seeds stay the same.
#pragma once

#include <cstdint>

namespace mural::testing {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

constexpr uint64_t rounds(uint64_t count) { return kSanitized ? (count + 7) / 8 : count; }

} // namespace mural::testing
