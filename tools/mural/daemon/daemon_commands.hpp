// mural node --wait: a daemon that waits for heads; mural call: the launch command for such nodes.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace mural::cli {

struct WaitArguments {
    bool wait = false;
    std::string secretFile;
    std::string listen = ":4279";
    std::string name; // empty: the host name
    std::string discovery = "auto";
};
void describeWait(CLI::App& node, WaitArguments& arguments);
int waitCommand(const WaitArguments& arguments);

struct CallArguments {
    std::string secretFile;
    std::string discovery = "auto";
    double seconds = 5;               // timeout of the search by name
    std::vector<std::string> command; // HOST MURAL ARGUMENTS...
};
void describeCall(CLI::App& call, CallArguments& arguments);
int callCommand(const CallArguments& arguments);

} // namespace mural::cli
