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
    int64_t frame = -1; // 0 where none is given
    std::string layout;
    std::string stereo; // "on", "off", or as the file says
};

void describeConfig(CLI::App& command, ConfigArguments& arguments);
int configCommand(const ConfigArguments& arguments);

} // namespace mural::cli
