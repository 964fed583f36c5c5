// Returns the bytes of a value in memory, as they are sent.
#pragma once

#include <cstddef>
#include <span>

namespace mural {

std::span<const std::byte> bytesOf(const auto& value) { return std::as_bytes(std::span(&value, 1)); }

} // namespace mural
