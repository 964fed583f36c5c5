// Options of `mural doctor --network`.
#pragma once

#include <string>
#include <vector>

namespace mural::cli {

struct NetworkArguments {
    std::string hosts; // comma-separated; empty: this machine only
    std::string launchCommand = "ssh -o BatchMode=yes";
    std::string remoteMural; // empty: this binary's path
    std::string group = "239.255.77.85:4277";
    std::string interface;
    std::string rate = "0";
    double seconds = 1; // length of the stream to each host
};

} // namespace mural::cli
