// Counts events by the command that causes them, in the memory that the head reads.
#pragma once

#include <cstring>

#include "common/ipc/capture_ring.hpp"

namespace mural {

// Requires the lock that guards the counts. The last entry collects the commands that find no free entry.
inline void countCommand(capture::CommandCount (&counts)[capture::kCommandCounts], const char* command) {
    uint32_t i = 0;
    for (; i + 1 < capture::kCommandCounts && counts[i].command[0]; ++i)
        if (std::strncmp(counts[i].command, command, sizeof counts[i].command - 1) == 0) break;
    capture::CommandCount& entry = counts[i];
    if (i + 1 == capture::kCommandCounts) command = "others";
    if (!entry.command[0]) std::strncpy(entry.command, command, sizeof entry.command - 1);
    entry.count.fetch_add(1, std::memory_order_release);
}

} // namespace mural
