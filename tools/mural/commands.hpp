// The subcommands of mural; each returns its exit status.
#pragma once

#include <string>
#include <vector>

#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

int runCommand(const RunOptions& options);
int doctorCommand(bool asJson);
int listCommandsCommand(bool onlyUnsupported);

struct StatOptions {
    bool asJson = false;
    double watchSeconds = 0; // 0: once
};
int statCommand(const StatOptions& options);
int versionCommand();

// Runs in a child of doctor with the environment of a captured program: checks that the capture library is loaded.
int preloadProbeCommand();

const char* muralVersion();
std::string versionText(); // "mural 0.1.0"

} // namespace mural::cli
