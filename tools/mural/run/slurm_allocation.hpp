// `mural run --slurm OPTIONS`: requests a Slurm job and runs in it.
#pragma once

#include <string>
#include <vector>

namespace mural::cli {

// Returns the salloc command that runs the same command line inside of a new job. arguments: of this process, without
// its name; the words of the program come last. options: of salloc, separated by spaces. Pure.
std::vector<std::string> sallocCommandOf(const std::string& mural, std::vector<std::string> arguments,
                                         const std::vector<std::string>& program, const std::string& options);

// Replaces this process with salloc, which returns the exit status of the run. Returns the exit status of a failure,
// which it has reported.
int becomeSalloc(const std::vector<std::string>& command);

} // namespace mural::cli
