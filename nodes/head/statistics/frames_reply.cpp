#include "nodes/head/statistics/frames_reply.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace mural {
namespace {

size_t spansIn(const FrameRecord& record) {
    size_t spans = 0;
    for (const SpanTrack& track : record.tracks) spans += track.spans.size() + 1;
    return spans;
}

} // namespace

nlohmann::json framesReply(const std::vector<FrameRecord>& records, uint64_t since) {
    nlohmann::json frames = nlohmann::json::array();
    uint64_t next = since;
    size_t spans = 0;
    bool hasMore = false;
    for (const FrameRecord& record : records) {
        spans += spansIn(record);
        hasMore = spans > kMaxReplySpans && !frames.empty();
        if (hasMore) break;
        next = record.number + 1;
        frames.push_back(toJson(record));
    }
    return {{"frames", std::move(frames)}, {"next", next}, {"more", hasMore}};
}

} // namespace mural
