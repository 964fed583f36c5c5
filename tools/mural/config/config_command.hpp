// mural config: checks, rewrites and draws a configuration file.
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace mural::cli {

struct ConfigArguments {
    std::string verb;
    std::string file;
    std::string out; // empty: standard output
    bool strict = false;
    bool resolved = false;
    int64_t frame = -1; // default: 0
    std::string layout;
    std::string stereo; // "on", "off"; empty: as in the file
};

void describeConfig(CLI::App& command, ConfigArguments& arguments);
int configCommand(const ConfigArguments& arguments);

} // namespace mural::cli
