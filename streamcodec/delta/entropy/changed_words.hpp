// Finds changed words among 64, with the vector instructions of the processor.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::delta {

constexpr uint32_t kComparedWords = 64;

// Returns one bit per word, kComparedWords in total, the lowest for the first. No alignment is required.
[[nodiscard]] uint64_t changedWords(const std::byte* old, const std::byte* now);

} // namespace mural::delta
