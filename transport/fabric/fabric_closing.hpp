// The last of a closed connection: libfabric sends only while somebody asks it to, and an end that disappears with messages
// unread may take the tail of its own stream along. So each closed channel has a thread until the other end has answered its Bye.
#pragma once

#include <memory>

#include "transport/fabric/fabric_channel.hpp"

namespace mural::fabric {

// For ten seconds at most; when the process ends, for one at most.
void drainInBackground(std::shared_ptr<Channel> channel);

} // namespace mural::fabric
