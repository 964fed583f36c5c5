// The head's side of a waiting node: has it run a process, and stands in for it here, as ssh does.
#pragma once

#include <string>
#include <vector>

#include "common/result.hpp"
#include "transport/secure_channel.hpp"

namespace mural {

struct NodeCall {
    std::vector<std::string> addresses; // to try one after the other: numbers or names
    uint16_t port = 4279;
    ChannelSecret secret{};
    std::vector<std::string> arguments; // of mural
};

// Standard input, output and errors are those of the process there; returns its exit status.
Result<int> callNode(const NodeCall& call);

} // namespace mural
