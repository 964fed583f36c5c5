// The last line of a session: its numbers (docs/reference/control-protocol.md).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "nodes/head/capture_memory.hpp"
#include "nodes/head/frame_tracker.hpp"
#include "nodes/head/picture_output.hpp"
#include "nodes/head/stream_economy.hpp"
#include "nodes/head/queue_totals.hpp"
#include "recording/file_writer.hpp"

namespace mural {

// Of the leader of a swap barrier.
struct SwapTotals {
    int64_t members = 0; // 0: it leads none
    int64_t swaps = 0;   // that were shown by more than one
    int64_t medianNs = 0, p99Ns = 0, mostNs = 0; // between the first and the last of them
    int64_t clockErrorNs = 0;
};

struct NodeTotals {
    int node = 0;
    int64_t frames = 0;
    double cpuSeconds = 0;      // of the whole process
    double replaySeconds = 0;   // CPU time of its replay thread: drawing…
    double readbackSeconds = 0; // …and reading the pictures
    int64_t commands = 0;
    int64_t exchangeBytes = 0;  // of pictures, to other nodes
    int64_t pictureBytes = 0, pictureRawBytes = 0; // of those that went to the head packed, and before
    SwapTotals swaps;
    bool lost = false;
    int64_t joins = 0;          // how often it came back
    int64_t snapshotBytes = 0;  // that it was given then, the last time…
    double secondsToBack = 0;   // …and from its loss to its first frame
};

// From a node's Bye; what is missing or odd stays 0.
void readBye(const std::string& json, NodeTotals& totals);

struct SessionNumbers {
    FrameTotals frames;
    uint64_t bytesSent = 0; // to each node
    EconomyCounts economy;
    std::vector<QueueTotals> queues;
    CaptureCounts programs;
    OutputTotals output;
    std::string lastPicture; // path
    std::string recording;   // path of --record; empty: none
    recording::WriterTotals recorded;
    bool drawnWhole = false; // see SlowdownAdvice
    std::vector<NodeTotals> nodes;
};

// [{"name": …}]; null: no tiles move.
nlohmann::json queuesJson(const std::vector<QueueTotals>& queues);

// {"records": …, "rawBytes": …}; null: it is off.
nlohmann::json economyJson(const EconomyCounts& counts);

nlohmann::json reportOf(const SessionNumbers& numbers);

// "room", "frames", "answer", "window", "nothing".
std::string waitName(capture::Wait wait);
// "front buffer", …: why `--verify` could not compare a frame.
std::string reasonText(capture::Uncompared reason);
nlohmann::json waitSecondsOf(const CaptureCounts& counts); // {"room": 0.5, …}

// Frames per second and bytes per frame of the last second or so. One thread.
class ProgressMeter {
public:
    struct Rates {
        double framesPerSecond = 0;
        int64_t bytesPerFrame = 0;
    };
    Rates sample(int64_t nowNs, int64_t frames, uint64_t bytes);

private:
    struct Sample {
        int64_t atNs = 0;
        int64_t frames = 0;
        uint64_t bytes = 0;
    };
    std::vector<Sample> samples_;
};

} // namespace mural
