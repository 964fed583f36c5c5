// The spans of a pump's thread by frames, and with them the program's spans. Used by that thread.
//
// A swap ends a frame (nodes/head/capture/frame_end.hpp). Frames that follow each other without a pause count as one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/head/statistics/frame_statistics.hpp"
#include "nodes/head/statistics/program_spans.hpp"

namespace mural {

class CaptureMemory;

class PumpSpans {
public:
    // statistics: null: none.
    PumpSpans(FrameStatistics* statistics, uint32_t client, const CaptureMemory& memory)
        : statistics_(statistics), client_(client), memory_(memory) {}

    // Call for each publication that the pump finds.
    void published(std::span<const std::byte> records);
    // Call when everything published has been sent.
    void sent();

private:
    FrameStatistics* const statistics_;
    const uint32_t client_;
    const CaptureMemory& memory_;
    ThreadSpans spans_;
    uint32_t endedFrame_ = 0; // the latest frame with a published end; 0: none since the last call of sent()
    int64_t publishedNs_ = 0; // that end
    int64_t frameNs_ = 0;     // the same of the frame before…
    ProgramWaits waits_{};    // …and the waits up to then
};

} // namespace mural
