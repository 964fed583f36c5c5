// The statistics of one frame: the spans of all threads that worked on it, on the head's clock
// (docs/reference/statistics.md).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/frame_spans/thread_spans.hpp"

namespace mural {

enum class SpanProcess : uint32_t { Program, Head, Node };

// The spans of one thread since its previous frame.
struct SpanTrack {
    SpanProcess process = SpanProcess::Head;
    int number = 0;     // of the node; of a reader in the head: its node; otherwise 0
    std::string thread; // "gl", "stream", "reader", "output", "window", "replay", "pictures"
    std::vector<Span> spans;

    bool operator==(const SpanTrack&) const = default;
};

struct FrameRecord {
    uint64_t number = 0; // in the order in which frames begin; over all programs
    uint32_t client = 0;
    uint32_t window = 0; // 0: no node has finished the frame
    uint32_t frame = 0;  // of the client, from 1
    int64_t doneNs = 0;  // all nodes have finished the frame, and the program has its credit; 0: not yet
    std::vector<SpanTrack> tracks;

    bool operator==(const FrameRecord&) const = default;
};

nlohmann::json toJson(const FrameRecord& record);
// Errors: missing members, other types, unknown kinds.
Result<FrameRecord> frameRecordFromJson(const nlohmann::json& json);

} // namespace mural
