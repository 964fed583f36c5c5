#include "tools/mural/stat/chrome_trace.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

namespace mural::cli {

namespace {

using Json = nlohmann::json;

// Process and thread ids of the trace.
constexpr int kHead = 1, kPrograms = 100, kNodes = 1000;
constexpr int kOutput = 1, kStreams = 100, kReaders = 1000, kWindows = 100'000; // threads of the head
constexpr int kReplay = 1, kPictures = 2;                                       // threads of a node

struct TraceThread {
    int process, thread;
    std::string processName, threadName;
};

TraceThread threadOf(const SpanTrack& track, const FrameRecord& record) {
    const auto client = static_cast<int>(record.client);
    switch (track.process) {
    case SpanProcess::Program: return {kPrograms + client, 1, fmt::format("program {}", client), "GL thread"};
    case SpanProcess::Node:
        return {kNodes + track.number, track.thread == "replay" ? kReplay : kPictures,
                fmt::format("node {}", track.number), track.thread};
    case SpanProcess::Head: break;
    }
    if (track.thread == "reader")
        return {kHead, kReaders + track.number, "head", fmt::format("reader of node {}", track.number)};
    if (track.thread == "stream")
        return {kHead, kStreams + client, "head", fmt::format("stream of program {}", client)};
    if (track.thread == "window")
        return {kHead, kWindows + client, "head", fmt::format("windows of program {}", client)};
    return {kHead, kOutput, "head", track.thread};
}

class TraceWriter {
public:
    explicit TraceWriter(const SessionFrames& frames) : frames_(frames) {
        for (const FrameRecord& record : frames.frames)
            for (const SpanTrack& track : record.tracks)
                for (const Span& span : track.spans) beginNs_ = std::min(beginNs_, span.beginNs);
    }

    Json write() {
        for (const FrameRecord& record : frames_.frames) {
            for (const SpanTrack& track : record.tracks) addTrack(record, track);
            addFlows(record);
            addFrameTime(record);
        }
        return {
            {"traceEvents", std::move(events_)},
            {"displayTimeUnit", "ms"},
            {"otherData",
             {{"session", frames_.status.value("session", "")}, {"clocks", frames_.clocks}, {"beginNs", beginNs_}}}};
    }

private:
    [[nodiscard]] double microseconds(int64_t ns) const { return static_cast<double>(ns - beginNs_) / 1000; }

    void addTrack(const FrameRecord& record, const SpanTrack& track) {
        const TraceThread thread = threadOf(track, record);
        name(thread);
        for (const Span& span : track.spans)
            events_.push_back({{"ph", "X"},
                               {"name", nameOf(span.kind)},
                               {"cat", wire::isWait(span.kind) ? "wait" : "work"},
                               {"ts", microseconds(span.beginNs)},
                               {"dur", static_cast<double>(span.ns()) / 1000},
                               {"pid", thread.process},
                               {"tid", thread.thread},
                               {"args", {{"client", record.client}, {"frame", record.frame}}}});
    }

    void name(const TraceThread& thread) {
        if (!named_.insert({thread.process, thread.thread}).second) return;
        const auto add = [&](const char* what, const std::string& text) {
            events_.push_back({{"ph", "M"},
                               {"name", what},
                               {"pid", thread.process},
                               {"tid", thread.thread},
                               {"args", {{"name", text}}}});
        };
        add("process_name", thread.processName);
        add("thread_name", thread.threadName);
        events_.push_back({{"ph", "M"},
                           {"name", "process_sort_index"},
                           {"pid", thread.process},
                           {"args", {{"sort_index", thread.process == kHead ? kPrograms - 1 : thread.process}}}});
    }

    // An arrow begins within the last work of one thread and ends within the first or last work of another.
    void addFlows(const FrameRecord& record) {
        const SpanTrack* program = find(record, SpanProcess::Program, 0, "gl");
        for (const SpanTrack& track : record.tracks) {
            if (track.process != SpanProcess::Node || track.thread != "replay") continue;
            const SpanTrack* pictures = find(record, SpanProcess::Node, track.number, "pictures");
            const SpanTrack* reader = find(record, SpanProcess::Head, track.number, "reader");
            if (program) addFlow(record, *program, track, true);
            if (reader) addFlow(record, pictures ? *pictures : track, *reader, false);
        }
    }

    void addFlow(const FrameRecord& record, const SpanTrack& from, const SpanTrack& to, bool toFirst) {
        const Span* const begin = workOf(from, false);
        const Span* const end = workOf(to, toFirst);
        if (!begin || !end) return;
        const uint64_t id = ++flows_;
        addFlowEnd("s", id, threadOf(from, record), begin->endNs - begin->ns() / 16);
        addFlowEnd("f", id, threadOf(to, record),
                   toFirst ? end->beginNs + end->ns() / 16 : end->endNs - end->ns() / 16);
    }

    void addFlowEnd(const char* phase, uint64_t id, const TraceThread& thread, int64_t ns) {
        Json event = {
            {"ph", phase},           {"name", "frame"},     {"cat", "flow"}, {"id", id}, {"ts", microseconds(ns)},
            {"pid", thread.process}, {"tid", thread.thread}};
        if (phase[0] == 'f') event["bp"] = "e"; // binds to the enclosing span
        events_.push_back(std::move(event));
    }

    static const Span* workOf(const SpanTrack& track, bool first) {
        const auto works = [](const Span& span) { return !wire::isWait(span.kind); };
        if (first) {
            const auto found = std::ranges::find_if(track.spans, works);
            return found == track.spans.end() ? nullptr : &*found;
        }
        const auto found = std::find_if(track.spans.rbegin(), track.spans.rend(), works);
        return found == track.spans.rend() ? nullptr : &*found;
    }

    static const SpanTrack* find(const FrameRecord& record, SpanProcess process, int number, const char* thread) {
        const auto found = std::ranges::find_if(record.tracks, [&](const SpanTrack& track) {
            return track.process == process && track.number == number && track.thread == thread;
        });
        return found == record.tracks.end() ? nullptr : &*found;
    }

    void addFrameTime(const FrameRecord& record) {
        if (record.doneNs == 0) return;
        int64_t& lastNs = lastNs_[{record.client, record.window}];
        if (lastNs != 0 && record.doneNs > lastNs)
            events_.push_back({{"ph", "C"},
                               {"name", fmt::format("frame time of program {}", record.client)},
                               {"pid", kHead},
                               {"ts", microseconds(lastNs)},
                               {"args", {{"ms", static_cast<double>(record.doneNs - lastNs) / 1e6}}}});
        lastNs = record.doneNs;
        events_.push_back({{"ph", "i"},
                           {"name", "frame done"},
                           {"s", "p"},
                           {"pid", kHead},
                           {"tid", kStreams + static_cast<int>(record.client)},
                           {"ts", microseconds(record.doneNs)},
                           {"args", {{"client", record.client}, {"window", record.window}, {"frame", record.frame}}}});
    }

    const SessionFrames& frames_;
    int64_t beginNs_ = INT64_MAX;
    Json events_ = Json::array();
    std::set<std::pair<int, int>> named_;
    std::map<std::pair<uint32_t, uint32_t>, int64_t> lastNs_; // by client and window
    uint64_t flows_ = 0;
};

} // namespace

Json chromeTrace(const SessionFrames& frames) { return TraceWriter(frames).write(); }

} // namespace mural::cli
