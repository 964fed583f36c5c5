// Creates the launcher of a session.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/launchers/launcher.hpp"
#include "nodes/launch/launchers/ssh_launcher.hpp"

namespace mural {

struct LaunchSettings {
    std::string how = "ssh"; // ssh, slurm, pmix, or a command that runs a command on a host
    std::string secretFile;  // of waiting nodes, whose names begin with @; empty: none
    std::string ownMural;    // path of mural on this machine
    NodeBinary binary;
    StarterVersion version;
    int64_t startTimeoutMs = 30'000; // until all processes of mpirun or srun have arrived
};

// environment: of this process; it names the batch job.
Result<std::unique_ptr<Launcher>> createLauncher(const LaunchSettings& settings,
                                                 const launch::Environment& environment);

} // namespace mural
