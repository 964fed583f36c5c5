#include "tools/mural/stat/frame_summary.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace mural::cli {

namespace {

double of(const StageMeans& means, SpanKind kind) { return means[static_cast<size_t>(kind)]; }

double sum(const StageMeans& means, bool waits) {
    double ms = 0;
    for (size_t i = 0; i < means.size(); ++i)
        if (wire::isWait(static_cast<SpanKind>(i)) == waits) ms += means[i];
    return ms;
}

// Returns the name of the longest wait without "wait: ".
std::string longestWait(const StageMeans& means) {
    const auto first = means.begin() + static_cast<std::ptrdiff_t>(SpanKind::WaitSpace);
    const auto longest = std::max_element(first, means.end());
    if (*longest <= 0) return "";
    const auto name = nameOf(static_cast<SpanKind>(longest - means.begin()));
    return std::string(name.substr(name.find(' ') + 1));
}

uint32_t busiestClient(const std::vector<FrameRecord>& frames) {
    std::map<uint32_t, size_t> counts;
    for (const FrameRecord& record : frames) counts[record.client] += record.doneNs != 0;
    const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
    return most == counts.end() ? 0 : most->first;
}

void add(StageMeans& means, const SpanTrack& track, double perFrame) {
    for (const Span& span : track.spans)
        means[static_cast<size_t>(span.kind)] += static_cast<double>(span.ns()) / 1e6 * perFrame;
}

} // namespace

std::string processName(SpanProcess process, int number) {
    switch (process) {
    case SpanProcess::Program: return "program";
    case SpanProcess::Head: return "head";
    case SpanProcess::Node: break;
    }
    return fmt::format("node {}", number);
}

FrameSummary summarize(const std::vector<FrameRecord>& frames) {
    FrameSummary summary;
    const uint32_t client = busiestClient(frames);
    int64_t firstNs = INT64_MAX, lastNs = 0;
    for (const FrameRecord& record : frames) {
        if (record.client != client || record.doneNs == 0) continue;
        ++summary.frames;
        firstNs = std::min(firstNs, record.doneNs);
        lastNs = std::max(lastNs, record.doneNs);
    }
    if (summary.frames > 1 && lastNs > firstNs) {
        summary.frameMs = static_cast<double>(lastNs - firstNs) / 1e6 / static_cast<double>(summary.frames - 1);
        summary.framesPerSecond = 1000 / summary.frameMs;
    }
    if (summary.frames == 0) return summary;
    const double perFrame = 1 / static_cast<double>(summary.frames);
    for (const FrameRecord& record : frames)
        for (const SpanTrack& track : record.tracks) {
            const int number = track.process == SpanProcess::Node ? track.number : 0;
            add(summary.stages[{track.process, number}], track, perFrame);
            if (track.thread == "replay") add(summary.replay[number], track, perFrame);
        }
    return summary;
}

FrameSummary::Slowest FrameSummary::slowest() const {
    Slowest found;
    for (const auto& [process, means] : stages)
        for (size_t i = 0; i < means.size(); ++i)
            if (!wire::isWait(static_cast<SpanKind>(i)) && means[i] > found.ms)
                found = {std::string(nameOf(static_cast<SpanKind>(i))), processName(process.first, process.second),
                         means[i]};
    return found;
}

std::vector<std::string> summaryLines(const FrameSummary& summary) {
    if (summary.frames < 2) return {"  frames   no statistics yet"};
    std::vector<std::string> lines;
    const FrameSummary::Slowest slowest = summary.slowest();
    lines.push_back(fmt::format("  frames   {:.2f} ms, {:.1f} frames/s; slowest stage: {} on {}, {:.2f} ms per frame",
                                summary.frameMs, summary.framesPerSecond, slowest.stage, slowest.where, slowest.ms));
    lines.push_back(fmt::format("  {:<8} {:>9} {:>9} {:>9} {:>9} {:>9}  {}", "ms", "busy", "wait", "readback",
                                "compress", "transfer", "longest wait"));
    for (const auto& [node, replay] : summary.replay) {
        const StageMeans& all = summary.stages.at({SpanProcess::Node, node});
        lines.push_back(fmt::format("  {:<8} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f}  {}",
                                    fmt::format("node {}", node), sum(replay, false), sum(replay, true),
                                    of(all, SpanKind::Readback) + of(all, SpanKind::WaitReadback),
                                    of(all, SpanKind::Compress), of(all, SpanKind::Transfer), longestWait(replay)));
    }
    return lines;
}

} // namespace mural::cli
