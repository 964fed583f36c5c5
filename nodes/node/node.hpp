// A render node process: takes the stream of the head, replays it on its GL, answers.
#pragma once

#include <string>

namespace mural {

struct NodeOptions {
    int connectFd = -1;  // shared memory, inherited from the head
    std::string connect; // or host:port; the session's secret comes on standard input
    std::string name;    // with it: by which the head knows that secret
};

// Until the head says that it is over, or is gone. Returns the process's exit status.
int runNode(const NodeOptions& options);

} // namespace mural
