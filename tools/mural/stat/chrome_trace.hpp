// Statistics of frames in the Chrome trace event format, which Perfetto and chrome://tracing show. Pure.
//
// Source: "Trace Event Format", Google, 2016.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/mural/stat/session_frames.hpp"

namespace mural::cli {

// Returns the trace: a process for the head, each node and each program; a track for each of their threads; arrows from
// the program's frame to the nodes and from the nodes to the head; the time of each frame as a counter.
nlohmann::json chromeTrace(const SessionFrames& frames);

} // namespace mural::cli
