// The numbers of a session, sent as its last line (docs/reference/control-protocol.md).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nodes/head/capture/capture_memory.hpp"
#include "nodes/head/frames/frame_tracker.hpp"
#include "nodes/head/frames/picture_output.hpp"
#include "nodes/head/broadcast/delta_stream.hpp"
#include "nodes/head/balancing/equalizer_totals.hpp"
#include "nodes/head/recording/recording_status.hpp"
#include "nodes/head/session/slowdown_advice.hpp"

namespace mural {

// Numbers of a swap barrier, from its leader.
struct SwapTotals {
    int64_t members = 0;                        // 0: the node leads none
    int64_t swaps = 0;                          // swaps shown by more than one member
    int64_t medianNs = 0, p99Ns = 0, maxNs = 0; // time between the first and the last member of a swap
    int64_t clockErrorNs = 0;
};

// Vertices that a node did not draw, because they cannot touch its area.
struct CullingTotals {
    bool isOn = false;
    int64_t drawsLeftOut = 0, drawsCut = 0, drawsWhole = 0;
    int64_t verticesLeftOut = 0, verticesDrawn = 0;
    std::map<std::string, int64_t> verticesUnexamined; // by reason; they also count as drawn
    int64_t boxBytes = 0;                              // largest memory of the boxes
    int64_t audits = 0, faults = 0;                    // audited draws; draws with a sample in the area
};

struct NodeTotals {
    int node = 0;
    int64_t frames = 0;
    double cpuSeconds = 0;       // of the whole process
    int64_t peakMemoryBytes = 0; // largest resident memory of the process
    double replaySeconds = 0;    // CPU time of its replay thread: drawing…
    double readbackSeconds = 0;  // …and reading the pictures
    int64_t commands = 0;
    int64_t receivedBytes = 0;                     // from the head, since its last start
    int64_t exchangeBytes = 0;                     // picture bytes sent to other nodes
    int64_t pictureBytes = 0, pictureRawBytes = 0; // encoded pictures sent to the head: encoded and raw size
    SwapTotals swaps;
    CullingTotals culling;
    bool lost = false;
    bool hasConnected = false;
    int64_t joins = 0;          // number of returns
    int64_t snapshotBytes = 0;  // at the last return: size of the snapshot…
    double secondsToRejoin = 0; // …and time from the loss to the first frame
};

// Reads a node's Bye. Missing or invalid values stay 0.
void readGoodbye(const std::string& json, NodeTotals& totals);

struct SessionNumbers {
    FrameTotals frames;
    uint64_t bytesSent = 0; // to each node
    DeltaCounts delta;
    std::vector<EqualizerTotals> equalizers;
    CaptureCounts programs;
    OutputTotals output;
    std::string lastPicture;                  // path
    std::optional<RecordingStatus> recording; // the latest one
    bool drawnWhole = false;                  // see SlowdownAdvice
    std::vector<DivisionLimit> limits;
    SharedDraws sharedDraws;
    std::vector<NodeTotals> nodes;
};

// Returns [{"name": …}]. Null: no tiles move.
nlohmann::json equalizersJson(const std::vector<EqualizerTotals>& equalizers);

// Returns {"records": …, "rawBytes": …}. Null: delta coding is off.
nlohmann::json deltaJson(const DeltaCounts& counts);

nlohmann::json reportOf(const SessionNumbers& numbers);

// Returns "space", "frames", "reply", "window" or "nothing".
std::string waitName(capture::Wait wait);
// Returns why `--verify` could not compare a frame, such as "front buffer".
std::string reasonText(capture::Uncompared reason);
nlohmann::json waitSecondsOf(const CaptureCounts& counts); // {"space": 0.5, …}

// Frames per second and bytes per frame over about the last second. Used by one thread.
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
