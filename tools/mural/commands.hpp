// The subcommands of mural; each returns its exit status.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

int runCommand(const RunOptions& options);
// The rank of this process if it is a further process of mpirun or srun, which runs nodes for rank 0; otherwise 0.
int nodeRankOf(const RunOptions& options);
int runRank(const RunOptions& options, int rank);
int doctorCommand(bool asJson);
int listCommandsCommand(bool onlyUnsupported);

struct StatOptions {
    std::string session; // name, or pid of its `mural run`; empty: all sessions
    bool asJson = false;
    bool asPrometheus = false;
    std::string traceFile;   // empty: none
    int64_t frames = 300;    // in the trace
    double watchSeconds = 0; // 0: once
};
int statCommand(const StatOptions& options);
int versionCommand();
// details: of version_details.hpp.
int verboseVersionCommand(const std::vector<std::pair<std::string, std::string>>& details);

// Runs in a child of doctor with the environment of a captured program: checks that the capture library is loaded.
int preloadProbeCommand();

const char* muralVersion();
std::string versionText(); // "mural 0.1.0"

} // namespace mural::cli
