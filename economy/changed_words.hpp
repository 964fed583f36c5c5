// Which words of 64 are not as they were, by vectors of what processor there is.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::economy {

constexpr uint32_t kComparedWords = 64;

// A bit for each of kComparedWords words, the lowest for the first. Anywhere in memory.
[[nodiscard]] uint64_t changedWords(const std::byte* old, const std::byte* now);

} // namespace mural::economy
