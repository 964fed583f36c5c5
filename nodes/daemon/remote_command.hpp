// Runs a command of Mural for a head. Forwards between its pipes and the head's channel.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/daemon/channel_socket.hpp"

namespace mural {

// Allows nodes that connect to a head, and members for `mural doctor --network`.
bool isAllowedCommand(const std::vector<std::string>& arguments);
// Replaces a bare port in the arguments by the peer's address and the port.
void completeCommand(std::vector<std::string>& arguments, const std::string& peer);

// Runs until the process ends, the head is gone, or `stop`. Returns how the process ended; it no longer runs.
Result<std::string> runRemoteCommand(const std::string& executable, const std::vector<std::string>& arguments,
                                     ChannelSocket& channel, const std::atomic<bool>& stop);

} // namespace mural
