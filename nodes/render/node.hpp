// A render node process: receives the head's stream, has it drawn by a player, and replies.
#pragma once

#include <string>

#include "nodes/player/stream_player.hpp"

namespace mural {

struct NodeOptions {
    int connectFd = -1;  // shared memory, inherited from the head
    std::string connect; // or host:port, several separated by commas; the session's secret arrives on standard input
    std::string name;    // with `connect`: identifies the secret to the head
};

// Runs until the session ends or the head is gone. Returns the exit status of the process.
int runNode(const NodeOptions& options, const MakePlayer& makePlayer);

} // namespace mural
