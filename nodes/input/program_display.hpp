// The X display of a program: its name and the authority to open it. Reads /proc.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <sys/types.h>

#include "common/base/result.hpp"

namespace mural::input {

struct ProgramDisplay {
    std::string name;       // ":99"
    std::string authority;  // path of the authority file; empty: the user's own
    bool isPrivate = false; // started by `mural run` for this program
    uint32_t window = 0;    // of the program; 0: unknown

    bool operator==(const ProgramDisplay&) const = default;
};

// name: as the head reports it; empty: the program's DISPLAY. runPid: the process of `mural run`, whose authority files
// are below /proc/PID/fd. Errors: the program has no display.
Result<ProgramDisplay> programDisplay(pid_t program, pid_t runPid, std::string name, uint32_t window);

// Returns the value of a variable in the contents of /proc/PID/environ; empty: none. Pure.
[[nodiscard]] std::string variableIn(std::string_view environment, std::string_view name);
// Returns the cookie of the last entry of an authority file; empty: it has none. Pure.
[[nodiscard]] std::string cookieIn(std::string_view authorityFile);

} // namespace mural::input
