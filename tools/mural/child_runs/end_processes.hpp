// Ends runs with all their processes. Requires launch::adoptOrphans().
#pragma once

#include <cstdint>
#include <sys/types.h>

#include "nodes/launch/child_process.hpp"

namespace mural::cli {

// Ends a `mural run` in order. It ends its processes at the first signal, and stops waiting for pictures at the second.
// Each signal has graceMs; then all descendants of this process are killed, except the display.
void endWithAll(launch::ChildProcess& child, pid_t display, int64_t graceMs);
// Kills the descendants of this process, except the display. A killed `mural run` leaves some, which would write into
// folders during their removal.
void killOrphans(pid_t display);

} // namespace mural::cli
