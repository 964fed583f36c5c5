// UUIDs (RFC 9562) that identify machines.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace mural {

using Uuid = std::array<std::byte, 16>;

// Returns "01234567-89ab-cdef-0123-456789abcdef".
std::string uuidText(const Uuid& uuid);
std::optional<Uuid> uuidFromText(std::string_view text);
// Sets the version bits of a UUID with private contents (version 8).
Uuid markedUuid(Uuid bits);

} // namespace mural
