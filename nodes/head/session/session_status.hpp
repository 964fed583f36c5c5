// The state of a running session for `mural stat`: totals and their time. A client derives rates from two requests.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "nodes/head/broadcast/node_multicast.hpp"
#include "nodes/head/capture/capture_memory.hpp"
#include "nodes/head/frames/frame_tracker.hpp"
#include "nodes/head/session/session_report.hpp"

namespace mural {

struct ProgramStatus {
    uint32_t id = 0;
    pid_t pid = 0;
    std::string command;
    ClientProgress progress;
    uint64_t bytesSent = 0; // to each node
    CaptureCounts counts;
    std::vector<int> waitsForNodes; // at the moment
};

struct NodeStatus {
    NodeTotals totals;
    std::string where; // "local", or the host
    int64_t pid = 0;
    std::string gl;
    double silentSeconds = 0;                                   // since its last message
    std::string stream;                                         // transport of its packets: memory, TCP, multicast
    bool returning = false;                                     // lost, and being restarted
    bool isStopped = false;                                     // by an operator, until it is started again
    std::optional<NodeMulticast::Losses> losses = std::nullopt; // of the multicast stream; empty: it has another one
};

struct SessionStatus {
    std::string session;
    int64_t runPid = 0;
    int64_t headPid = 0;
    int64_t nowNs = 0;
    int columns = 1, rows = 1;
    std::string display; // app, windows, none
    int64_t wallFrames = 0;
    uint32_t latency = 0;                   // frames that programs may be ahead, at the moment
    std::optional<double> revertsInSeconds; // of the last change; empty: it stays
    std::optional<RecordingStatus> recording;
    DeltaCounts delta;
    std::vector<EqualizerTotals> equalizers;
    std::vector<ProgramStatus> programs;
    std::vector<NodeStatus> nodes;
    std::optional<rsp::SenderCounters> multicast; // of the head; empty: no node receives multicast
};

nlohmann::json statusOf(const SessionStatus& status);

// The command line of a process, its words separated by spaces; '?' replaces unprintable characters. Empty: no such
// process.
std::string commandLineOf(pid_t pid);

} // namespace mural
