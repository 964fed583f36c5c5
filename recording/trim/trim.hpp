// Some frames of a recording, with all that they need of the frames before: `mural trim`.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/result.hpp"
#include "recording/file_reader.hpp"

namespace mural::recording {

struct TrimReport {
    int64_t frames = 0;
    uint64_t recordsBefore = 0;  // in the frames before
    uint64_t recordsDropped = 0; // of these
    uint64_t drawsBefore = 0;    // draw calls there
    uint64_t drawsDropped = 0;
    uint64_t fileBytes = 0;
    std::map<uint32_t, std::string> doubts; // programs whose draws are all kept, and why
};

// Frames of the wall, from 1, both included. The file at `path` is overwritten.
Result<TrimReport> trim(FileReader& reader, int64_t firstFrame, int64_t lastFrame, const std::string& path);

} // namespace mural::recording
