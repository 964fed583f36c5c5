// A recording as text: `mural dump`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "recording/file_reader.hpp"

namespace mural::recording {

struct DumpOptions {
    int64_t firstFrame = 1;         // of the wall
    int64_t lastFrame = INT64_MAX;
    std::vector<std::string> calls; // names, with * for any characters; empty: all
    bool summary = false;           // counts and bytes instead of calls
};

struct DumpReport {
    std::vector<std::string> absent; // of DumpOptions::calls, those that no call in the frames fits
};

// Whether the pattern fits a call that there may be in recordings: of a command of GL, or Mural.…
bool fitsSomeCall(const std::string& pattern);

// That there are frames up to the last one. What stands behind the recording's last frame is of one more, which did not end:
// what a program has said before it was killed.
Result<void> checkFrames(FileReader& reader, int64_t lastFrame);

// Gives the lines; false from `line` ends it without an error.
Result<DumpReport> dump(FileReader& reader, const DumpOptions& options, const std::function<bool(const std::string&)>& line);

} // namespace mural::recording
