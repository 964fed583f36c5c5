// `mural run --verify`: compares what the nodes drew with what the program's own context drew.
#pragma once

#include "common/ipc/capture_ring.hpp"

namespace mural {

struct ThreadState;
struct Window;

// Compares the window's back buffer with the nodes' picture and adds to the counts of the report. A window that is not
// current is bound for the read. A frame that cannot be compared is counted with its reason.
void verifyFrame(ThreadState& t, Window& w);
void countUncompared(capture::Uncompared reason);

} // namespace mural
