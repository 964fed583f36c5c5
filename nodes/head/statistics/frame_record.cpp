#include "nodes/head/statistics/frame_record.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 3> kProcesses = {"program", "head", "node"};

Json toJson(const SpanTrack& track) {
    Json spans = Json::array();
    for (const Span& span : track.spans) spans.push_back({static_cast<uint32_t>(span.kind), span.beginNs, span.endNs});
    return {{"process", kProcesses[static_cast<size_t>(track.process)]},
            {"number", track.number},
            {"thread", track.thread},
            {"spans", std::move(spans)}};
}

// Throws exceptions of nlohmann::json.
SpanTrack trackFromJson(const Json& json) {
    SpanTrack track;
    const auto process = json.at("process").get<std::string>();
    for (size_t i = 0; i < kProcesses.size(); ++i)
        if (process == kProcesses[i]) track.process = static_cast<SpanProcess>(i);
    track.number = json.at("number").get<int>();
    track.thread = json.at("thread").get<std::string>();
    for (const Json& span : json.at("spans")) {
        const auto kind = span.at(0).get<uint32_t>();
        if (kind >= wire::kSpanKinds) continue;
        track.spans.push_back({static_cast<SpanKind>(kind), span.at(1).get<int64_t>(), span.at(2).get<int64_t>()});
    }
    return track;
}

} // namespace

Json toJson(const FrameRecord& record) {
    Json tracks = Json::array();
    for (const SpanTrack& track : record.tracks) tracks.push_back(toJson(track));
    return {{"number", record.number}, {"client", record.client}, {"window", record.window},
            {"frame", record.frame},   {"doneNs", record.doneNs}, {"tracks", std::move(tracks)}};
}

Result<FrameRecord> frameRecordFromJson(const Json& json) {
    try {
        FrameRecord record;
        record.number = json.at("number").get<uint64_t>();
        record.client = json.at("client").get<uint32_t>();
        record.window = json.at("window").get<uint32_t>();
        record.frame = json.at("frame").get<uint32_t>();
        record.doneNs = json.at("doneNs").get<int64_t>();
        for (const Json& track : json.at("tracks")) record.tracks.push_back(trackFromJson(track));
        return record;
    } catch (const Json::exception& e) {
        return Error{std::string("invalid statistics of a frame: ") + e.what()};
    }
}

} // namespace mural
