#include "nodes/head/session/session_status.hpp"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/base/clock.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr size_t kMaxCommandBytes = 4096;

Json programJson(const ProgramStatus& program) {
    return {
        {"client", program.id},
        {"pid", program.pid},
        {"command", program.command},
        {"frames", program.progress.finished},
        {"calls", program.progress.calls},
        {"bytes", program.bytesSent},
        {"roundTrips", program.counts.roundTrips},
        {"roundTripsBy", program.counts.tripsBy},
        {"waitSeconds", waitSecondsOf(program.counts)},
        {"waitingFor", waitName(program.counts.waitingFor)},
        {"waitsForNodes", program.waitsForNodes},
    };
}

// Repairs serve the whole group, so no node has a number of its own.
Json multicastJson(const std::optional<rsp::SenderCounters>& counters) {
    if (!counters) return nullptr;
    return {{"bytes", counters->bytes},
            {"datagrams", counters->datagrams},
            {"repairs", counters->resent},
            {"parity", counters->rows}};
}

Json nodeJson(const NodeStatus& node) {
    return {
        {"lost", node.losses ? Json(node.losses->lost) : Json()},
        {"dropped", node.losses ? Json(node.losses->dropped) : Json()},
        {"node", node.totals.node},
        {"where", node.where},
        {"pid", node.pid},
        {"gl", node.gl},
        {"state", node.returning     ? "rejoining"
                  : node.isStopped   ? "stopped"
                  : node.totals.lost ? "lost"
                                     : "alive"},
        {"silentSeconds", node.silentSeconds},
        {"stream", node.stream},
        {"frames", node.totals.frames},
        {"replaySeconds", node.totals.replaySeconds},
        {"readbackSeconds", node.totals.readbackSeconds},
        {"pictureBytes", node.totals.pictureBytes},
        {"pictureRawBytes", node.totals.pictureRawBytes},
        {"joins", node.totals.joins},
        {"snapshotBytes", node.totals.snapshotBytes},
        {"secondsToRejoin", node.totals.secondsToRejoin},
    };
}

} // namespace

Json statusOf(const SessionStatus& status) {
    Json programs = Json::array();
    for (const ProgramStatus& program : status.programs) programs.push_back(programJson(program));
    Json nodes = Json::array();
    for (const NodeStatus& node : status.nodes) nodes.push_back(nodeJson(node));
    return {
        {"session", status.session},
        {"runPid", status.runPid},
        {"headPid", status.headPid},
        {"atSeconds", static_cast<double>(status.nowNs) / static_cast<double>(kNsPerS)},
        {"tiles", std::to_string(status.columns) + "x" + std::to_string(status.rows)},
        {"display", status.display},
        {"frames", status.wallFrames},
        {"latency", status.latency},
        {"revertsInSeconds", status.revertsInSeconds ? Json(*status.revertsInSeconds) : Json()},
        {"recording", status.recording ? recordingJson(*status.recording) : Json()},
        {"delta", deltaJson(status.delta)},
        {"equalizers", equalizersJson(status.equalizers)},
        {"multicast", multicastJson(status.multicast)},
        {"programs", programs},
        {"nodes", nodes},
    };
}

std::string commandLineOf(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/cmdline", std::ios::binary);
    std::string line{std::istreambuf_iterator<char>(file), {}};
    while (!line.empty() && line.back() == '\0') line.pop_back();
    if (line.size() > kMaxCommandBytes) line.resize(kMaxCommandBytes);
    for (char& c : line) {
        if (c == '\0') c = ' ';
        if (c < ' ' || c > '~') c = '?';
    }
    return line;
}

} // namespace mural
