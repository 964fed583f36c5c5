#include "tools/mural/stat/session_frames.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace mural::cli {

Result<void> addReply(SessionFrames& frames, const nlohmann::json& reply) {
    const auto list = reply.find("frames"), next = reply.find("next"), status = reply.find("status");
    if (list == reply.end() || !list->is_array() || next == reply.end() || !next->is_number_unsigned() ||
        status == reply.end() || !status->is_object())
        return Error{"the head sent invalid statistics; install mural and its head from one build"};
    for (const nlohmann::json& json : *list) {
        auto record = frameRecordFromJson(json);
        if (!record) return record.error();
        frames.frames.push_back(std::move(*record));
    }
    frames.next = next->get<uint64_t>();
    frames.hasMore = reply.value("more", false) && !list->empty();
    frames.status = *status;
    frames.clocks = reply.value("clocks", nlohmann::json::array());
    return {};
}

void dropPartialBegin(SessionFrames& frames) {
    using Thread = std::tuple<SpanProcess, int, std::string>;
    constexpr std::ptrdiff_t kPartial = 64; // more than the frames in progress
    const auto threadsOf = [](const FrameRecord& record) {
        std::set<Thread> threads;
        for (const SpanTrack& track : record.tracks)
            if (track.process == SpanProcess::Node) threads.insert({track.process, track.number, track.thread});
        return threads;
    };
    std::set<Thread> all;
    for (const FrameRecord& record : frames.frames) all.merge(threadsOf(record));
    const auto limit = frames.frames.begin() + std::min<std::ptrdiff_t>(kPartial, std::ssize(frames.frames));
    const auto first =
        std::find_if(frames.frames.begin(), limit, [&](const FrameRecord& record) { return threadsOf(record) == all; });
    if (first == limit) return;
    // A frame whose first track is the report of its end has a higher number than the frame after it.
    const auto isEarlier = [client = first->client, frame = first->frame](const FrameRecord& record) {
        return record.client == client && record.frame < frame;
    };
    frames.frames.erase(std::remove_if(first, limit, isEarlier), limit);
    frames.frames.erase(frames.frames.begin(), first);
}

} // namespace mural::cli
