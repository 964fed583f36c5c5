// How a render node that comes over TCP proves that it belongs to this session. The head hands each
// node its own 32 random bytes as one line of 64 hex digits on the node's standard input; the node
// sends them, raw, as the first bytes on its connection. Nothing else is read before they match.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "common/result.hpp"

namespace mural {

constexpr size_t kSecretBytes = 32;
using SessionSecret = std::array<std::byte, kSecretBytes>;

Result<SessionSecret> makeSessionSecret(); // from the kernel's random numbers
std::string toHex(const SessionSecret& secret);
Result<SessionSecret> sessionSecretFromHex(const std::string& line); // a line end is allowed

// In a time that does not depend on where they differ.
bool sameSecret(const SessionSecret& a, const SessionSecret& b);

} // namespace mural
