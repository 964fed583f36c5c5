// Packets as control bytes and what these refer to, each kind by itself: equals compress better with their own kind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::economy {

enum class Section : uint8_t { Control, Words, Texts, Pages };
constexpr size_t kSections = 4;

using SectionBytes = std::array<std::span<const std::byte>, kSections>;

} // namespace mural::economy
