// Prints a trace as text: `mural dump`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "streamcodec/trace/trace_reader.hpp"

namespace mural::trace {

struct DumpOptions {
    int64_t firstFrame = 1; // of the wall
    int64_t lastFrame = INT64_MAX;
    std::vector<std::string> calls; // name patterns, with * for any characters; empty: all
    bool summary = false;           // counts and bytes instead of calls
};

struct DumpReport {
    std::vector<std::string> absent; // patterns of DumpOptions::calls without a match in these frames
};

// Returns true if the pattern matches a call that traces can contain: a GL command, or Mural....
bool fitsSomeCall(const std::string& pattern);

// Checks that the trace has frames up to the last one. Data after the last complete frame counts as one more frame: the
// calls of a program before it was killed.
Result<void> checkFrames(TraceReader& reader, int64_t lastFrame);

// Passes each line to `line`, whose result false stops without an error.
Result<DumpReport> dump(TraceReader& reader, const DumpOptions& options,
                        const std::function<bool(const std::string&)>& line);

} // namespace mural::trace
