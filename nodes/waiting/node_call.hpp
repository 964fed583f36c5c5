// The head's client of a daemon: runs a process there and acts as its local stand-in, as ssh does.
#pragma once

#include <string>
#include <vector>

#include "common/result.hpp"
#include "transport/secure_channel.hpp"

namespace mural {

struct NodeCall {
    std::vector<std::string> addresses; // tried in order: numeric or names
    uint16_t port = 4279;
    ChannelSecret secret{};
    std::vector<std::string> arguments; // of mural
};

// Connects standard input, output and error to the remote process, and returns its exit status.
Result<int> callNode(const NodeCall& call);

} // namespace mural
