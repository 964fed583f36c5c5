// The options of `mural doctor --network`.
#pragma once

#include <string>
#include <vector>

namespace mural::cli {

struct NetworkArguments {
    std::string hosts; // separated by commas; empty: this machine alone
    std::string launchCommand = "ssh -o BatchMode=yes";
    std::string remoteMural; // empty: this one's path
    std::string group = "239.255.77.85:4277";
    std::string interface;
    std::string rate = "0";
    double seconds = 1; // of the stream to each host
};

} // namespace mural::cli
