// 128 bits that tell machines apart, as everybody writes them (RFC 9562).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace mural {

using Uuid = std::array<std::byte, 16>;

// "01234567-89ab-cdef-0123-456789abcdef".
std::string uuidText(const Uuid& uuid);
std::optional<Uuid> uuidFromText(std::string_view text);
// Marks 16 bytes as a UUID whose other bits mean nothing to others (version 8).
Uuid markedUuid(Uuid bits);

} // namespace mural
