// How a render node that comes over TCP proves that it belongs to this session, and learns that the head is it. The head
// hands each node its own 32 random bytes as one line of 64 hex digits on the node's standard input; they are never sent,
// but proven (transport/secure_channel.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "common/result.hpp"
#include "transport/secure_channel.hpp"

namespace mural {

using SessionSecret = ChannelSecret;

Result<SessionSecret> makeSessionSecret(); // from the kernel's random numbers
std::string toHex(const SessionSecret& secret);
Result<SessionSecret> sessionSecretFromHex(const std::string& line); // a line end is allowed

} // namespace mural
