// Extracts frames of a trace together with everything they need of earlier frames: `mural trim`.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.hpp"
#include "streamcodec/trace/trace_reader.hpp"

namespace mural::trace {

struct TrimReport {
    int64_t frames = 0;
    uint64_t recordsBefore = 0;  // in earlier frames
    uint64_t recordsWritten = 0; // of these
    uint64_t drawsBefore = 0;    // draw calls, primitives and display list calls in earlier frames
    uint64_t drawsWritten = 0;
    uint64_t fileBytes = 0;
};

// Extracts wall frames, from 1, inclusive. Overwrites the file at `path`.
Result<TrimReport> trim(TraceReader& reader, int64_t firstFrame, int64_t lastFrame, const std::string& path);

} // namespace mural::trace
