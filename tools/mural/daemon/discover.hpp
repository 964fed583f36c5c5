// mural discover: lists daemons on this network.
#pragma once

#include <CLI/App.hpp>

#include "transport/discovery/discovery.hpp"

namespace mural::cli {

struct DiscoverArguments {
    double seconds = 2;
    std::string interface;
    bool noBeacon = false;
    bool noAvahi = false;
    bool asJson = false;
};

void describeDiscover(CLI::App& command, DiscoverArguments& arguments);
int discoverCommand(const DiscoverArguments& arguments);

} // namespace mural::cli
