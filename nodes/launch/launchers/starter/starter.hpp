// A starter: the process on another host that starts and ends the render nodes there, for a head that is connected to
// its standard input and output by ssh or by a batch system. It ends with its standard input, and with it all nodes:
// nothing stays behind, whatever happens to the head or the connection.
#pragma once

#include <string>

#include "nodes/launch/launchers/launcher.hpp"

namespace mural::launch {

struct StarterOptions {
    NodeBinary binary;   // only `program` and `isNative`
    std::string version; // of mural
    std::string build;   // of the stream format
};

// Runs until standard input ends, the head is silent while no node runs, or a signal arrives. Returns the exit status.
int runStarter(const StarterOptions& options);

} // namespace mural::launch
