// mural config: looks at a configuration file, writes it again, draws it.
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
    uint64_t frame = 0;
    std::string layout;
    std::string stereo; // "on", "off", or as the file says
};

void describeConfig(CLI::App& command, ConfigArguments& arguments);
int configCommand(const ConfigArguments& arguments);

} // namespace mural::cli
