#include "nodes/head/statistics/frame_statistics.hpp"

#include <utility>

#include "nodes/frame_spans/frame_spans_message.hpp"

namespace mural {

bool FrameStatistics::request(int64_t nowNs) {
    const std::lock_guard lock(mutex_);
    requestedNs_ = nowNs;
    if (isOn_.exchange(true)) return false;
    ring_.clear();
    return true;
}

bool FrameStatistics::expire(int64_t nowNs) {
    if (!isOn()) return false;
    const std::lock_guard lock(mutex_);
    if (nowNs - requestedNs_ < kLeaseNs) return false;
    isOn_ = false;
    return true;
}

void FrameStatistics::add(uint32_t client, uint32_t frame, SpanTrack track, int64_t nowNs) {
    if (!isOn() || track.spans.empty()) return;
    const std::lock_guard lock(mutex_);
    ring_.add(client, frame, std::move(track), nowNs);
}

void FrameStatistics::addNode(int node, const wire::FrameSpansHeader& header, const std::vector<wire::FrameSpan>& spans,
                              int64_t nowNs) {
    if (!isOn()) return;
    constexpr std::pair<wire::SpanThread, const char*> kThreads[] = {{wire::SpanThread::Replay, "replay"},
                                                                     {wire::SpanThread::Pictures, "pictures"}};
    const std::lock_guard lock(mutex_);
    NodeClock& clock = clocks_[static_cast<size_t>(node)];
    clock.addMessage(header.sentNs, nowNs);
    if (!clock.isKnown()) return;
    const int64_t offsetNs = clock.offsetNs();
    for (const auto& [thread, name] : kThreads) {
        SpanTrack track{SpanProcess::Node, node, name, spansOf(spans, thread)};
        for (Span& span : track.spans) span.beginNs -= offsetNs, span.endNs -= offsetNs;
        if (!track.spans.empty()) ring_.add(header.client, header.frame, std::move(track), nowNs);
    }
}

void FrameStatistics::finish(uint32_t client, uint32_t window, uint32_t frame, int64_t nowNs) {
    if (!isOn()) return;
    const std::lock_guard lock(mutex_);
    ring_.finish(client, window, frame, nowNs);
}

void FrameStatistics::addRoundTrip(int node, const ClockSample& sample) {
    const std::lock_guard lock(mutex_);
    clocks_[static_cast<size_t>(node)].addRoundTrip(sample);
}

std::vector<NodeClock> FrameStatistics::clocks() const {
    const std::lock_guard lock(mutex_);
    return clocks_;
}

void FrameStatistics::addNode(NodeClock clock) {
    const std::lock_guard lock(mutex_);
    clocks_.push_back(clock);
}

void FrameStatistics::forgetClock(int node) {
    const std::lock_guard lock(mutex_);
    NodeClock& clock = clocks_[static_cast<size_t>(node)];
    if (clock.errorNs() != 0) clock = NodeClock();
}

std::vector<FrameRecord> FrameStatistics::since(uint64_t number, int64_t nowNs, size_t newest) const {
    const std::lock_guard lock(mutex_);
    return ring_.since(number, nowNs, newest);
}

} // namespace mural
