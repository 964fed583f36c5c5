// A process of Mural that a head has ordered, between its pipes and the head's channel.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "nodes/waiting/channel_socket.hpp"

namespace mural {

// What may be ordered: nodes that connect to a head, and members for `mural doctor --network`.
bool mayBeOrdered(const std::vector<std::string>& arguments);
// Who orders a node by a port alone is where it connects to.
void completeOrder(std::vector<std::string>& arguments, const std::string& peer);

// Until the process has ended, the head is gone, or `stop`; returns how it ended. The process is gone then.
Result<std::string> runOrdered(const std::string& executable, const std::vector<std::string>& arguments, ChannelSocket& channel, const std::atomic<bool>& stop);

} // namespace mural
