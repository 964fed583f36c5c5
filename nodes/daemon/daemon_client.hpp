// The head's client of a daemon: runs a process there and acts as its local stand-in, as ssh does.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural {

struct DaemonClient {
    std::vector<std::string> addresses; // tried in order: numeric or names
    uint16_t port = 4279;
    ChannelSecret secret{};
    std::vector<std::string> arguments; // of mural
};

// Connects standard input, output and error to the remote process, and returns its exit status.
Result<int> callNode(const DaemonClient& call);

} // namespace mural
