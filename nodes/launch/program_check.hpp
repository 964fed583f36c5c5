// Can Mural capture this program? Finds it as a shell would and looks at what the loader would make
// of it: the loader ignores LD_PRELOAD for set-id programs and is not there at all for static ones.
#pragma once

#include <string>

namespace mural::launch {

// Exit statuses of `mural run` that are not the program's own; 126 and 127 as in a shell.
constexpr int kExitUsage = 2;
constexpr int kExitNotExecutable = 126;
constexpr int kExitNotFound = 127;

struct ProgramCheck {
    std::string path;    // what to execute
    std::string binary;  // the file that the loader starts for it: of a script, its interpreter
    int exitStatus = 0;  // 0: fine
    std::string message; // one line when it is not
    [[nodiscard]] bool ok() const { return exitStatus == 0; }
};

// searchPath: value of PATH; used when the name has no slash.
ProgramCheck checkProgram(const std::string& name, const std::string& searchPath);

// Only finds: 127 when there is none, 126 when it may not be executed.
ProgramCheck findProgram(const std::string& name, const std::string& searchPath);

} // namespace mural::launch
