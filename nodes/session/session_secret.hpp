// Mutual authentication of the head and a node on TCP. The head gives each node its own 32 random bytes, as one line of
// 64 hex digits on standard input. Neither end sends the secret; each proves it (transport/secure/secure_channel.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "common/base/result.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural {

using SessionSecret = ChannelSecret;

Result<SessionSecret> makeSessionSecret(); // from the kernel's random number generator
std::string toHex(const SessionSecret& secret);
Result<SessionSecret> sessionSecretFromHex(const std::string& line); // accepts a trailing newline

} // namespace mural
