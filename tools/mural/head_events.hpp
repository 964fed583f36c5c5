// The lines that the head sends to `mural run` (docs/reference/control-protocol.md). Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::cli {

// Numbers of a swap barrier, from its leader.
struct SwapReport {
    int64_t members = 0; // 0: the node leads none
    int64_t swaps = 0;
    double medianNs = 0, p99Ns = 0, maxNs = 0, clockErrorNs = 0;
};

// Vertices that a node left out (docs/architecture/culling.md).
struct CullingReport {
    bool isOn = false;
    int64_t verticesLeftOut = 0, verticesDrawn = 0;
    std::map<std::string, int64_t> verticesUnexamined; // by reason; they also count as drawn
    int64_t audits = 0, faults = 0;
};

struct NodeReport {
    int64_t node = 0;
    int64_t frames = 0;
    double cpuSeconds = 0;
    bool lost = false;
    bool hasConnected = false;
    SwapReport swaps;
    int64_t joins = 0; // number of returns; the next two describe the last one
    double secondsToRejoin = 0, snapshotBytes = 0;
    double pictureBytes = 0, pictureRawBytes = 0; // encoded pictures sent to the head: encoded and raw size
    CullingReport culling;
};

// Savings by the filter and delta coding.
struct DeltaReport {
    bool on = false;
    double records = 0;
    double rawBytes = 0;
    double stagedBytes = 0; // size after replacement by references
    double wireBytes = 0;   // size after compression
    double pageHits = 0, newPages = 0;
    double encodeSeconds = 0;
    double deferredRecords = 0;                  // records deferred until their first use
    double droppedRecords = 0, droppedBytes = 0; // deferred records that were never needed
};

// Numbers of one equalizer.
struct EqualizerReport {
    std::string name, kind;
    std::string divides; // "picture", "draws" or "frames"; "zoom": it changes a zoom
    int64_t frames = 0, moves = 0;
    double efficiency = 0;                         // 1: all nodes were busy for the same time; 0 for "frames", "zoom"
    double framesPerSecond = 0;                    // highest rate, for "frames"; 0: no limit
    double zoom = 0;                               // relative to the file, for "zoom"
    std::vector<std::pair<int64_t, double>> nodes; // node, and its part of the picture or the draws
};

struct SessionReport {
    int64_t frames = 0;
    double seconds = 0;
    double framesPerSecond = 0;
    double bytesPerFrame = 0;
    int64_t callsUnsupported = 0;
    std::map<std::string, int64_t> callsUnsupportedBy; // number of unsupported calls by command
    int64_t roundTrips = 0;
    std::map<std::string, int64_t> roundTripsBy; // number of round trips by command
    int64_t verifiedFrames = 0;
    int64_t verifiedPixels = 0;
    int64_t differingPixels = 0;
    int64_t squaredDifference = 0; // sum over all components, including alpha
    int64_t largestDifference = 0;
    int64_t uncomparedFrames = 0;                      // frames that `--verify` could not compare
    std::map<std::string, int64_t> uncomparedFramesBy; // number of frames by reason
    int64_t savedPictures = 0;
    std::string lastPicture;
    std::string recording; // path; empty: no recording
    int64_t recordedFrames = 0;
    int64_t recordedBytes = 0;
    DeltaReport delta;
    std::vector<EqualizerReport> equalizers;
    std::vector<NodeReport> nodes;
    std::string json; // the complete report of the head
};

struct HeadEvent {
    enum class Kind {
        Ready,
        Error,
        Clients,
        Frame,
        FramesReached,
        StopRequested,
        JobOver,
        WallLost,
        Say,
        Report,
        Unknown
    };
    Kind kind = Kind::Unknown;
    std::string text;                 // Error, Say
    std::vector<std::string> explain; // Ready
    int64_t clients = 0;              // Clients
    int64_t frame = 0;                // Frame
    double framesPerSecond = 0;
    double bytesPerFrame = 0;
    SessionReport report; // Report
};

// Parses one line. Unknown: an event of a later version. Errors: not a JSON object with an event.
Result<HeadEvent> parseHeadEvent(const std::string& line);

} // namespace mural::cli
