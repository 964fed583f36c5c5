// What the head says, line by line (docs/reference/control-protocol.md). Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace mural::cli {

// Of windows on several nodes that show frames together; by the node that leads them.
struct SwapReport {
    int64_t members = 0; // 0: it leads none
    int64_t swaps = 0;
    double medianNs = 0, p99Ns = 0, mostNs = 0, clockErrorNs = 0;
};

struct NodeReport {
    int64_t node = 0;
    int64_t frames = 0;
    double cpuSeconds = 0;
    bool lost = false;
    SwapReport swaps;
    int64_t joins = 0; // how often it came back, and of the last time:
    double secondsToBack = 0, snapshotBytes = 0;
    double pictureBytes = 0, pictureRawBytes = 0; // that it sent packed, and what they were before
};

// What was spared the nodes that are not sent again what they have had.
struct EconomyReport {
    bool on = false;
    double records = 0;
    double rawBytes = 0;
    double stagedBytes = 0; // after references
    double wireBytes = 0;   // and compression
    double storeHits = 0, newPages = 0;
    double encodeSeconds = 0;
    double heldRecords = 0;    // that waited for their first use
    double leftOutRecords = 0, leftOutBytes = 0; // and those that nobody ever needed
};

// Tiles that nodes took from a queue.
struct QueueReport {
    std::string name;
    std::string of;                        // "tiles" or "chunks"
    int64_t columns = 0, rows = 0;         // 0: none was dealt
    int64_t tileWidth = 0, tileHeight = 0; // pixels
    int64_t frames = 0, moves = 0, tilesMoved = 0;
    std::vector<std::pair<int64_t, int64_t>> nodes; // and the tiles that each has
};

struct SessionReport {
    int64_t frames = 0;
    double seconds = 0;
    double framesPerSecond = 0;
    double bytesPerFrame = 0;
    int64_t callsUnsupported = 0;
    int64_t roundTrips = 0;
    std::map<std::string, int64_t> roundTripsBy; // command → how many it caused
    int64_t verifiedFrames = 0;
    int64_t verifiedPixels = 0;
    int64_t differingPixels = 0;
    int64_t squaredDifference = 0; // of all components, alpha among them
    int64_t largestDifference = 0;
    int64_t uncomparedFrames = 0; // that `--verify` could not compare
    std::map<std::string, int64_t> uncomparedFramesBy; // reason → how many
    int64_t savedPictures = 0;
    std::string lastPicture;
    std::string recording; // path; empty: none was made
    int64_t recordedFrames = 0;
    int64_t recordedBytes = 0;
    EconomyReport economy;
    std::vector<QueueReport> queues;
    std::vector<NodeReport> nodes;
    std::string json; // the whole, as the head said it
};

struct HeadEvent {
    enum class Kind { Ready, Error, Clients, Frame, FramesReached, WallLost, Say, Report, Unknown };
    Kind kind = Kind::Unknown;
    std::string text;                 // Error, Say
    std::vector<std::string> explain; // Ready
    int64_t clients = 0;              // Clients
    int64_t frame = 0;                // Frame
    double framesPerSecond = 0;
    double bytesPerFrame = 0;
    SessionReport report; // Report
};

// Fails on what is not a JSON object with an event. Events of a later head are Unknown.
Result<HeadEvent> parseHeadEvent(const std::string& line);

} // namespace mural::cli
