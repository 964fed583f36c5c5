#include "nodes/head/session/session_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "common/json/json_text.hpp"
#include "common/base/clock.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

int64_t wholeOf(const Json& json, const char* name) {
    const auto found = json.find(name);
    return found != json.end() && found->is_number_integer() ? found->get<int64_t>() : 0;
}

Json swapJson(const SwapTotals& s) {
    if (s.members == 0) return nullptr;
    return {{"members", s.members}, {"swaps", s.swaps}, {"medianNs", s.medianNs},
            {"p99Ns", s.p99Ns},     {"maxNs", s.maxNs}, {"clockErrorNs", s.clockErrorNs}};
}

Json limitsJson(const std::vector<DivisionLimit>& limits) {
    Json list = Json::array();
    for (const DivisionLimit& limit : limits) list.push_back({{"code", limit.code}, {"text", limit.text}});
    return list;
}

Json sharedDrawsJson(const SharedDraws& draws) {
    if (draws.frames == 0) return nullptr;
    return {{"frames", draws.frames}, {"shared", draws.shared}};
}

double secondsOf(int64_t ns) { return static_cast<double>(ns) / static_cast<double>(kNsPerS); }

void readCulling(const Json& json, CullingTotals& c) {
    c = {true,
         wholeOf(json, "drawsLeftOut"),
         wholeOf(json, "drawsCut"),
         wholeOf(json, "drawsWhole"),
         wholeOf(json, "verticesLeftOut"),
         wholeOf(json, "verticesDrawn"),
         {},
         wholeOf(json, "boxBytes"),
         wholeOf(json, "audits"),
         wholeOf(json, "faults")};
    const auto reasons = json.find("verticesUnexamined");
    if (reasons == json.end() || !reasons->is_object()) return;
    for (const auto& [reason, vertices] : reasons->items())
        c.verticesUnexamined[reason] = wholeOf(*reasons, reason.c_str());
}

// Null: culling is off.
Json cullingJson(const CullingTotals& c) {
    if (!c.isOn) return nullptr;
    return {{"drawsLeftOut", c.drawsLeftOut},
            {"drawsCut", c.drawsCut},
            {"drawsWhole", c.drawsWhole},
            {"verticesLeftOut", c.verticesLeftOut},
            {"verticesDrawn", c.verticesDrawn},
            {"verticesUnexamined", c.verticesUnexamined},
            {"boxBytes", c.boxBytes},
            {"audits", c.audits},
            {"faults", c.faults}};
}

} // namespace

void readGoodbye(const std::string& text, NodeTotals& totals) {
    const Json json = parseJson(text);
    if (!json.is_object()) return;
    totals.commands = wholeOf(json, "commands");
    totals.receivedBytes = wholeOf(json, "receivedBytes");
    totals.exchangeBytes = wholeOf(json, "exchangeBytes");
    totals.peakMemoryBytes = wholeOf(json, "peakMemoryBytes");
    totals.pictureBytes = wholeOf(json, "pictureBytes");
    totals.pictureRawBytes = wholeOf(json, "pictureRawBytes");
    if (const auto swaps = json.find("swapBarrier"); swaps != json.end() && swaps->is_object())
        totals.swaps = {wholeOf(*swaps, "members"), wholeOf(*swaps, "swaps"), wholeOf(*swaps, "medianNs"),
                        wholeOf(*swaps, "p99Ns"),   wholeOf(*swaps, "maxNs"), wholeOf(*swaps, "clockErrorNs")};
    if (const auto c = json.find("culling"); c != json.end() && c->is_object()) readCulling(*c, totals.culling);
    const auto seconds = json.find("cpuSeconds");
    if (seconds != json.end() && seconds->is_number()) totals.cpuSeconds = seconds->get<double>();
}

std::string waitName(capture::Wait wait) {
    switch (wait) {
    case capture::Wait::Space: return "space";
    case capture::Wait::Frames: return "frames";
    case capture::Wait::Reply: return "reply";
    case capture::Wait::Window: return "window";
    case capture::Wait::Nothing: break;
    }
    return "nothing";
}

Json waitSecondsOf(const CaptureCounts& counts) {
    Json seconds = Json::object();
    for (uint32_t i = 1; i < capture::kWaits; ++i)
        seconds[waitName(static_cast<capture::Wait>(i))] = secondsOf(static_cast<int64_t>(counts.waitNs[i]));
    return seconds;
}

std::string reasonText(capture::Uncompared reason) {
    switch (reason) {
    case capture::Uncompared::NoContext: return "swapped without a current context";
    case capture::Uncompared::NotBindable: return "window not current";
    case capture::Uncompared::Front: return "front buffer";
    case capture::Uncompared::NoSize: return "window size unknown";
    case capture::Uncompared::NoMemory: return "out of memory";
    case capture::Uncompared::NotReadable: return "own picture not readable";
    case capture::Uncompared::NoAnswer: break;
    }
    return "no reply from the nodes";
}

Json uncomparedJson(const CaptureCounts& counts) {
    Json reasons = Json::object();
    for (uint32_t i = 0; i < capture::kUncomparedReasons; ++i)
        if (counts.uncomparedFrames[i] > 0)
            reasons[reasonText(static_cast<capture::Uncompared>(i))] = counts.uncomparedFrames[i];
    return reasons;
}

const char* nameOf(Division division) {
    switch (division) {
    case Division::Areas: return "picture";
    case Division::Ranges: return "draws";
    case Division::Zooms: return "zoom";
    case Division::Frames: break;
    }
    return "frames";
}

// The area is x, y, width and height from the upper left corner.
Json shareJson(const NodeShare& share) {
    Json json = {{"node", share.node}, {"part", share.part}};
    if (share.area) json["area"] = {share.area->x, 1 - share.area->y - share.area->h, share.area->w, share.area->h};
    json["measuredMs"] = share.measuredMs ? Json(*share.measuredMs) : Json();
    json["predictedMs"] = share.predictedMs ? Json(*share.predictedMs) : Json();
    return json;
}

Json equalizersJson(const std::vector<EqualizerTotals>& equalizers) {
    if (equalizers.empty()) return nullptr;
    Json list = Json::array();
    for (const EqualizerTotals& e : equalizers) {
        Json nodes = Json::array();
        for (const NodeShare& share : e.nodes) nodes.push_back(shareJson(share));
        Json parameters = Json::object();
        for (const auto& [name, value] : e.parameters) parameters[name] = value;
        list.push_back({{"name", e.id},
                        {"parameters", parameters},
                        {"kind", e.kind},
                        {"divides", nameOf(e.division)},
                        {"frozen", e.frozen},
                        {"decision", e.decision},
                        {"frames", e.frames},
                        {"moves", e.moves},
                        {"taken", e.taken},
                        {"efficiency", e.efficiency},
                        {"framesPerSecond", e.framesPerSecond},
                        {"zoom", e.zoom},
                        {"nodes", nodes}});
    }
    return list;
}

Json deltaJson(const DeltaCounts& c) {
    if (!c.on) return nullptr;
    return {{"records", c.packer.records},
            {"rawBytes", c.packer.rawBytes},
            {"stagedBytes", c.packer.stagedBytes},
            {"wireBytes", c.wireBytes},
            {"pageHits", c.packer.pageHits},
            {"newPages", c.packer.newPages},
            {"patches", c.packer.patches},
            {"encodeSeconds", secondsOf(static_cast<int64_t>(c.encodeNs))},
            {"programBytes", c.filter.inBytes},
            {"deferredRecords", c.filter.deferredRecords},
            {"deferredBytes", c.filter.deferredBytes},
            {"droppedRecords", c.filter.droppedRecords},
            {"droppedBytes", c.filter.droppedBytes}};
}

Json reportOf(const SessionNumbers& n) {
    const double seconds = secondsOf(n.frames.latestNs - n.frames.firstNs);
    const int64_t frames = n.frames.wallFrames;
    int64_t calls = 0;
    Json nodes = Json::array();
    for (const NodeTotals& node : n.nodes) {
        calls = std::max(calls, node.commands);
        nodes.push_back({{"node", node.node},
                         {"frames", node.frames},
                         {"cpuSeconds", node.cpuSeconds},
                         {"peakMemoryBytes", node.peakMemoryBytes},
                         {"replaySeconds", node.replaySeconds},
                         {"readbackSeconds", node.readbackSeconds},
                         {"commands", node.commands},
                         {"receivedBytes", node.receivedBytes},
                         {"exchangeBytes", node.exchangeBytes},
                         {"pictureBytes", node.pictureBytes},
                         {"pictureRawBytes", node.pictureRawBytes},
                         {"swapBarrier", swapJson(node.swaps)},
                         {"culling", cullingJson(node.culling)},
                         {"lost", node.lost},
                         {"hasConnected", node.hasConnected},
                         {"joins", node.joins},
                         {"snapshotBytes", node.snapshotBytes},
                         {"secondsToRejoin", node.secondsToRejoin}});
    }
    return {
        {"event", "report"},
        {"frames", frames},
        {"seconds", seconds},
        // Between the first and the last frame lie frames - 1 intervals.
        {"framesPerSecond", seconds > 0 ? static_cast<double>(frames - 1) / seconds : 0.0},
        {"bytesPerFrame", frames > 0 ? n.bytesSent / static_cast<uint64_t>(frames) : 0},
        {"delta", deltaJson(n.delta)},
        {"equalizers", equalizersJson(n.equalizers)},
        {"calls", calls},
        {"roundTrips", n.programs.roundTrips},
        {"roundTripsBy", n.programs.tripsBy},
        {"waitSeconds", secondsOf(static_cast<int64_t>(
                            std::accumulate(n.programs.waitNs.begin(), n.programs.waitNs.end(), uint64_t{0})))},
        {"waitSecondsBy", waitSecondsOf(n.programs)},
        {"frameCpuSeconds", secondsOf(static_cast<int64_t>(n.programs.frameCpuNs))},
        {"frameCpuFrames", n.programs.frameCpuFrames},
        {"verifiedFrames", n.programs.verifiedFrames},
        {"verifiedPixels", n.programs.verifiedPixels},
        {"differingPixels", n.programs.differingPixels},
        {"squaredDifference", n.programs.squaredDifference},
        {"largestDifference", n.programs.largestDifference},
        {"uncomparedFrames",
         std::accumulate(n.programs.uncomparedFrames.begin(), n.programs.uncomparedFrames.end(), uint64_t{0})},
        {"uncomparedFramesBy", uncomparedJson(n.programs)},
        {"drawnWhole", n.drawnWhole},
        {"limits", limitsJson(n.limits)},
        {"sharedDraws", sharedDrawsJson(n.sharedDraws)},
        {"callsUnsupported", n.programs.callsUnsupported},
        {"callsUnsupportedBy", n.programs.unsupportedBy},
        {"savedPictures", n.output.savedPictures},
        {"lastPicture", n.lastPicture},
        {"recording", n.recording ? n.recording->file : ""},
        {"recordedFrames", n.recording ? n.recording->frames : 0},
        {"recordedBytes", n.recording ? n.recording->bytes : 0},
        {"nodes", nodes},
    };
}

ProgressMeter::Rates ProgressMeter::sample(int64_t nowNs, int64_t frames, uint64_t bytes) {
    const Sample now{nowNs, frames, bytes};
    Rates rates;
    if (!samples_.empty()) {
        const Sample& then = samples_.front();
        const int64_t newFrames = now.frames - then.frames;
        const double seconds = secondsOf(now.atNs - then.atNs);
        if (seconds > 0) rates.framesPerSecond = static_cast<double>(newFrames) / seconds;
        if (newFrames > 0) rates.bytesPerFrame = static_cast<int64_t>(now.bytes - then.bytes) / newFrames;
    }
    samples_.push_back(now);
    while (samples_.size() > 2 && nowNs - samples_.front().atNs > kNsPerS) samples_.erase(samples_.begin());
    return rates;
}

} // namespace mural
