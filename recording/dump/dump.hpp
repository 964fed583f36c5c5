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

// Gives the lines; false from `line` ends it without an error.
Result<void> dump(FileReader& reader, const DumpOptions& options, const std::function<bool(const std::string&)>& line);

} // namespace mural::recording
