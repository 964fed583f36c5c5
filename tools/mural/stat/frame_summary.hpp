// Means over the frames of a session: the time of each stage, on each process. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/mural/stat/session_frames.hpp"

namespace mural::cli {

using StageMeans = std::array<double, wire::kSpanKinds>; // ms per frame, by SpanKind

struct FrameSummary {
    size_t frames = 0; // complete ones of the program with most frames
    double framesPerSecond = 0;
    double frameMs = 0;
    // Of all threads of a process together. The number is that of a node, otherwise 0.
    std::map<std::pair<SpanProcess, int>, StageMeans> stages;
    std::map<int, StageMeans> replay; // the replay thread of each node alone

    // The stage with the longest time that is no wait.
    struct Slowest {
        std::string stage; // empty: no frames
        std::string where; // "node 2", "head", "program"
        double ms = 0;
    };
    [[nodiscard]] Slowest slowest() const;
};

FrameSummary summarize(const std::vector<FrameRecord>& frames);

// Returns a line for the frame and one per node, for `mural stat --watch`.
std::vector<std::string> summaryLines(const FrameSummary& summary);

// Returns "head", "program" or "node 2".
std::string processName(SpanProcess process, int number);

} // namespace mural::cli
