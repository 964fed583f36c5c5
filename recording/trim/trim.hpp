// Some frames of a recording, with all that they need of the frames before: `mural trim`.
#pragma once

#include <cstdint>
#include <string>

#include "common/result.hpp"
#include "recording/file_reader.hpp"

namespace mural::recording {

struct TrimReport {
    int64_t frames = 0;
    uint64_t recordsBefore = 0; // in the frames before
    uint64_t recordsKept = 0;   // of these
    uint64_t drawsBefore = 0;   // draw calls there, primitives, and calls of display lists
    uint64_t drawsKept = 0;
    uint64_t fileBytes = 0;
};

// Frames of the wall, from 1, both included. The file at `path` is overwritten.
Result<TrimReport> trim(FileReader& reader, int64_t firstFrame, int64_t lastFrame, const std::string& path);

} // namespace mural::recording
