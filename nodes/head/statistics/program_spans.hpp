// Spans of a program's frame, from the counters that it keeps anyway: the program itself measures nothing more. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/ipc/capture_ring.hpp"
#include "nodes/frame_spans/thread_spans.hpp"

namespace mural {

using ProgramWaits = std::array<uint64_t, capture::kWaits>; // total ns, by capture::Wait

// Returns the spans between the publications of two frames. waits: totals at the first and at the second time. The
// waits come first, because the wait for credit follows the publication; the places of the others are unknown.
std::vector<Span> programSpans(int64_t beginNs, int64_t endNs, const ProgramWaits& before, const ProgramWaits& after);

} // namespace mural
