// Checks whether Mural can capture a program. Finds it as a shell does. The loader ignores LD_PRELOAD for set-id
// programs, and static programs have no loader.
#pragma once

#include <string>

namespace mural::launch {

// Exit statuses of `mural run` itself; 126 and 127 as in a shell.
constexpr int kExitUsage = 2;
constexpr int kExitNotExecutable = 126;
constexpr int kExitNotFound = 127;

struct ProgramCheck {
    std::string path;    // path of the executable
    std::string binary;  // the file that the loader starts: for a script, its interpreter
    int exitStatus = 0;  // 0: can be captured
    std::string message; // one line, if exitStatus is not 0
    [[nodiscard]] bool ok() const { return exitStatus == 0; }
};

// searchPath: value of PATH, for names without a slash.
ProgramCheck checkProgram(const std::string& name, const std::string& searchPath);

// Only finds the program. 127: not found. 126: not executable.
ProgramCheck findProgram(const std::string& name, const std::string& searchPath);

} // namespace mural::launch
