// `mural replay`: a session whose program is the player of a trace.
#pragma once

#include <string>

#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

struct ReplayArguments {
    std::string file;
    bool pace = false;
    bool loop = false;
    RunArguments run; // for the session
};

void describeReplay(CLI::App& command, ReplayArguments& arguments);
Result<RunOptions> replayOptionsFrom(const ReplayArguments& arguments);
int replayCommand(const RunOptions& options, const std::string& file);

} // namespace mural::cli
