// A session with two nodes and three frames of 10 ms, for tests of its output.
#pragma once

#include "common/json/json_text.hpp"
#include "tools/mural/stat/session_frames.hpp"

namespace mural::cli {

constexpr int64_t kSampleMs = 1'000'000;

inline SessionFrames sampleFrames() {
    SessionFrames frames;
    frames.status = parseJson(R"({
        "session": "mural-7-\"x\\", "frames": 40,
        "programs": [{"client": 1, "frames": 41, "bytes": 1e6, "roundTrips": 3, "waitSeconds": {"frames": 1.5}}],
        "nodes": [{"node": 0, "state": "alive", "frames": 40, "replaySeconds": 2.25, "readbackSeconds": 0.5},
                  {"node": 1, "state": "lost", "frames": 12}]})");
    frames.clocks = parseJson(R"([{"node": 1, "offsetNs": 5, "errorNs": 40000}])");
    for (uint32_t frame = 1; frame <= 3; ++frame) {
        const int64_t atNs = int64_t{1'000'000'000'000} + frame * 10 * kSampleMs;
        FrameRecord record{frame, 1, 2, frame, atNs + 9 * kSampleMs, {}};
        record.tracks.push_back({SpanProcess::Program, 0, "gl", {{SpanKind::Capture, atNs, atNs + kSampleMs}}});
        record.tracks.push_back(
            {SpanProcess::Head, 0, "stream", {{SpanKind::Send, atNs + kSampleMs, atNs + 2 * kSampleMs}}});
        for (int node = 0; node < 2; ++node) {
            const int64_t drawnNs = atNs + (5 + node) * kSampleMs;
            record.tracks.push_back({SpanProcess::Node,
                                     node,
                                     "replay",
                                     {{SpanKind::WaitPackets, atNs, atNs + 2 * kSampleMs},
                                      {SpanKind::Replay, atNs + 2 * kSampleMs, drawnNs},
                                      {SpanKind::Readback, drawnNs, drawnNs + kSampleMs}}});
            record.tracks.push_back({SpanProcess::Node,
                                     node,
                                     "pictures",
                                     {{SpanKind::Compress, drawnNs + kSampleMs, drawnNs + 2 * kSampleMs}}});
            record.tracks.push_back({SpanProcess::Head,
                                     node,
                                     "reader",
                                     {{SpanKind::WaitNode, atNs, drawnNs + 2 * kSampleMs},
                                      {SpanKind::Assemble, drawnNs + 2 * kSampleMs, drawnNs + 3 * kSampleMs}}});
        }
        frames.frames.push_back(record);
    }
    return frames;
}

} // namespace mural::cli
