// The sections of a batch: control bytes, and the data they refer to, separated by kind, because data of one kind
// compresses better.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::delta {

// Spans and Words describe changed pages. Control includes the changes of short entries.
enum class Section : uint8_t { Control, Words, Texts, Pages, Spans };
constexpr size_t kSections = 5;

using SectionBytes = std::array<std::span<const std::byte>, kSections>;

} // namespace mural::delta
