#include "tools/mural/head_events.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

// Fields of another type than expected count as absent: no line from outside may throw.
int64_t whole(const Json& j, const char* name) {
    const auto it = j.find(name);
    return it != j.end() && it->is_number() ? it->get<int64_t>() : 0;
}
double real(const Json& j, const char* name) {
    const auto it = j.find(name);
    return it != j.end() && it->is_number() ? it->get<double>() : 0.0;
}
std::string text(const Json& j, const char* name) {
    const auto it = j.find(name);
    return it != j.end() && it->is_string() ? it->get<std::string>() : std::string();
}
bool truth(const Json& j, const char* name) {
    const auto it = j.find(name);
    return it != j.end() && it->is_boolean() && it->get<bool>();
}

HeadEvent::Kind kindOf(const std::string& name) {
    using Kind = HeadEvent::Kind;
    if (name == "ready") return Kind::Ready;
    if (name == "error") return Kind::Error;
    if (name == "clients") return Kind::Clients;
    if (name == "frame") return Kind::Frame;
    if (name == "frames-reached") return Kind::FramesReached;
    if (name == "stop-requested") return Kind::StopRequested;
    if (name == "job-over") return Kind::JobOver;
    if (name == "wall-lost") return Kind::WallLost;
    if (name == "say") return Kind::Say;
    if (name == "report") return Kind::Report;
    return Kind::Unknown;
}

DeltaReport deltaFrom(const Json& j) {
    if (!j.is_object()) return {};
    return {true,
            real(j, "records"),
            real(j, "rawBytes"),
            real(j, "stagedBytes"),
            real(j, "wireBytes"),
            real(j, "pageHits"),
            real(j, "newPages"),
            real(j, "encodeSeconds"),
            real(j, "deferredRecords"),
            real(j, "droppedRecords"),
            real(j, "droppedBytes")};
}

std::vector<EqualizerReport> equalizersFrom(const Json& list) {
    std::vector<EqualizerReport> equalizers;
    if (!list.is_array()) return equalizers;
    for (const Json& e : list) {
        if (!e.is_object()) continue;
        equalizers.push_back({text(e, "name"),
                              text(e, "kind"),
                              text(e, "divides"),
                              whole(e, "frames"),
                              whole(e, "moves"),
                              real(e, "efficiency"),
                              real(e, "framesPerSecond"),
                              real(e, "zoom"),
                              {}});
        const auto nodes = e.find("nodes");
        if (nodes == e.end() || !nodes->is_array()) continue;
        for (const Json& n : *nodes)
            if (n.is_object()) equalizers.back().nodes.emplace_back(whole(n, "node"), real(n, "part"));
    }
    return equalizers;
}

SwapReport swapsFrom(const Json& j) {
    if (!j.is_object()) return {};
    return {whole(j, "members"), whole(j, "swaps"), real(j, "medianNs"),
            real(j, "p99Ns"),    real(j, "maxNs"),  real(j, "clockErrorNs")};
}

std::map<std::string, int64_t> countsFrom(const Json& j, const char* name) {
    std::map<std::string, int64_t> counts;
    const auto by = j.find(name);
    if (by == j.end() || !by->is_object()) return counts;
    for (const auto& [key, count] : by->items())
        if (count.is_number()) counts[key] = count.get<int64_t>();
    return counts;
}

CullingReport cullingFrom(const Json& j) {
    if (!j.is_object()) return {};
    return {true,
            whole(j, "verticesLeftOut"),
            whole(j, "verticesDrawn"),
            countsFrom(j, "verticesUnexamined"),
            whole(j, "audits"),
            whole(j, "faults")};
}

SessionReport reportFrom(const Json& j) {
    SessionReport r;
    r.frames = whole(j, "frames");
    r.seconds = real(j, "seconds");
    r.framesPerSecond = real(j, "framesPerSecond");
    r.bytesPerFrame = real(j, "bytesPerFrame");
    r.callsUnsupported = whole(j, "callsUnsupported");
    r.callsUnsupportedBy = countsFrom(j, "callsUnsupportedBy");
    r.roundTrips = whole(j, "roundTrips");
    r.roundTripsBy = countsFrom(j, "roundTripsBy");
    r.verifiedFrames = whole(j, "verifiedFrames");
    r.verifiedPixels = whole(j, "verifiedPixels");
    r.differingPixels = whole(j, "differingPixels");
    r.squaredDifference = whole(j, "squaredDifference");
    r.largestDifference = whole(j, "largestDifference");
    r.uncomparedFrames = whole(j, "uncomparedFrames");
    r.uncomparedFramesBy = countsFrom(j, "uncomparedFramesBy");
    r.savedPictures = whole(j, "savedPictures");
    r.lastPicture = text(j, "lastPicture");
    r.recording = text(j, "recording");
    r.recordedFrames = whole(j, "recordedFrames");
    r.recordedBytes = whole(j, "recordedBytes");
    if (const auto delta = j.find("delta"); delta != j.end()) r.delta = deltaFrom(*delta);
    if (const auto e = j.find("equalizers"); e != j.end()) r.equalizers = equalizersFrom(*e);
    if (const auto nodes = j.find("nodes"); nodes != j.end() && nodes->is_array()) {
        for (const Json& n : *nodes) {
            if (!n.is_object()) continue;
            const auto swaps = n.find("swapBarrier");
            r.nodes.push_back({whole(n, "node"), whole(n, "frames"), real(n, "cpuSeconds"), truth(n, "lost"),
                               truth(n, "hasConnected"), swapsFrom(swaps != n.end() ? *swaps : Json()),
                               whole(n, "joins"), real(n, "secondsToRejoin"), real(n, "snapshotBytes"),
                               real(n, "pictureBytes"), real(n, "pictureRawBytes"),
                               cullingFrom(n.value("culling", Json()))});
        }
    }
    return r;
}

} // namespace

Result<HeadEvent> parseHeadEvent(const std::string& line) {
    const Json j = parseJson(line);
    if (!j.is_object() || !j.contains("event")) {
        return Error{"the head sent an invalid event: " + line.substr(0, 80)};
    }
    HeadEvent event;
    event.kind = kindOf(text(j, "event"));
    event.text = text(j, "text");
    event.clients = whole(j, "count");
    event.frame = whole(j, "frame");
    event.framesPerSecond = real(j, "framesPerSecond");
    event.bytesPerFrame = real(j, "bytesPerFrame");
    if (const auto lines = j.find("explain"); lines != j.end() && lines->is_array()) {
        for (const Json& l : *lines) {
            if (l.is_string()) event.explain.push_back(l.get<std::string>());
        }
    }
    if (event.kind == HeadEvent::Kind::Report) {
        event.report = reportFrom(j);
        event.report.json = line;
    }
    return event;
}

} // namespace mural::cli
