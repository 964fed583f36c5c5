// `mural run --verify`: compares what the nodes drew with what the program's own context drew.
#pragma once

#include "common/capture_ring.hpp"

namespace mural {

struct ThreadState;
struct Window;

// Compares the window's back buffer; the counts go to the head's report. The window need not be current: it is bound with
// the thread's context for the moment. A frame that can't be compared is counted with its reason.
void verifyFrame(ThreadState& t, Window& w);
void countUncompared(capture::Uncompared reason);

} // namespace mural
