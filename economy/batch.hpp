// Packets as control bytes and what these refer to, each kind by itself: equals compress better with their own kind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::economy {

// Spans and Words: of pages that have changed. (Those of short items are among Control.)
enum class Section : uint8_t { Control, Words, Texts, Pages, Spans };
constexpr size_t kSections = 5;

using SectionBytes = std::array<std::span<const std::byte>, kSections>;

} // namespace mural::economy
