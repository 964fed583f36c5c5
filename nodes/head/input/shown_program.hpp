// The program whose picture the wall shows.
#pragma once

#include <cstdint>
#include <string>
#include <sys/types.h>

namespace mural {

struct ShownProgram {
    uint32_t client = 0; // its number in the session
    pid_t pid = 0;       // 0: it has ended
    std::string display; // empty: the one of its environment
    uint32_t window = 0; // X window; 0: unknown
};

} // namespace mural
