// The process that forks local nodes: it has loaded the GL driver, so its nodes need not. A node starts in a third of
// the CPU time of a new process, and shares the driver's relocated pages with the others
// (docs/measurements/performance.md).
#pragma once

#include <functional>

namespace mural {

// Serves requests of fork_protocol.hpp until the head closes controlFd, and returns the exit status of the process. In
// a forked node it returns the result of runNode(connectFd). Call it while this process has one thread.
int runForkServer(int controlFd, const std::function<int(int connectFd)>& runNode);

} // namespace mural
