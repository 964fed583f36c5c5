// mural netperf: measures multicast throughput, and the latency until all receivers have a message.
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace mural::cli {

struct NetperfArguments {
    std::string role = "local";
    std::string stream; // a group description, instead of the separate options
    std::string group = "239.255.77.85:4277";
    std::string interface;
    std::string control = ":4278";
    std::string secretFile;
    std::string seal = "auto";
    std::string rate = "0";
    std::string bytes = "64M";
    std::string message = "0";
    std::string window = "4096";
    unsigned members = 2;
    unsigned count = 500;
    size_t datagramBytes = 0;
    unsigned timelineMs = 0;
    double withinSeconds = 120;
    double leaveAfterSeconds = 0; // 0: stays to the end
    bool noParity = false;
    bool unchecked = false; // data is neither generated nor checked: cost of the transport alone
    bool noMulticast = false;
    bool asJson = false;
};

void describeNetperf(CLI::App& command, NetperfArguments& arguments);
int netperfCommand(const NetperfArguments& arguments);

} // namespace mural::cli
