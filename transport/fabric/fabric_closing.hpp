// Drains closed connections. libfabric sends only while it is polled. An end that disappears before it has read all
// messages can lose the tail of its own stream. Each closed channel therefore keeps a thread until the peer has
// answered its Bye.
#pragma once

#include <memory>

#include "transport/fabric/fabric_channel.hpp"

namespace mural::fabric {

// Drains for at most ten seconds; at process exit, for at most one.
void drainInBackground(std::shared_ptr<Channel> channel);

} // namespace mural::fabric
