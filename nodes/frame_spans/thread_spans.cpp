#include "nodes/frame_spans/thread_spans.hpp"

#include <algorithm>
#include <utility>

namespace mural {

namespace {

// Appends a span. A short one extends its predecessor, and one of the same kind continues it.
void append(std::vector<Span>& spans, const Span& span, int64_t minNs) {
    const bool follows = !spans.empty() && spans.back().endNs == span.beginNs;
    if (follows && (span.ns() < minNs || spans.back().kind == span.kind))
        spans.back().endNs = span.endNs;
    else if (span.ns() > 0)
        spans.push_back(span);
}

} // namespace

void ThreadSpans::start(SpanKind kind, int64_t nowNs) {
    if (std::exchange(isActive_, true)) return;
    spans_.clear();
    spans_.reserve(kMaxSpans + 1);
    kind_ = kind;
    sinceNs_ = nowNs;
}

SpanKind ThreadSpans::enter(SpanKind kind, int64_t nowNs) {
    if (!isActive_ || kind == kind_) return kind_;
    close(nowNs);
    return std::exchange(kind_, kind);
}

void ThreadSpans::close(int64_t nowNs) {
    nowNs = std::max(nowNs, sinceNs_);
    append(spans_, {kind_, sinceNs_, nowNs}, kMinNs);
    sinceNs_ = nowNs;
    if (spans_.size() > kMaxSpans) coarsen();
}

// Halves the number of spans: the shortest ones extend their predecessors.
void ThreadSpans::coarsen() {
    for (int64_t minNs = 2 * kMinNs; spans_.size() > kMaxSpans / 2; minNs *= 2) {
        std::vector<Span> fewer;
        fewer.reserve(kMaxSpans + 1);
        for (const Span& span : spans_) append(fewer, span, minNs);
        spans_.swap(fewer);
    }
}

std::vector<Span> ThreadSpans::take(int64_t untilNs) {
    if (!isActive_) return {};
    if (untilNs > sinceNs_) close(untilNs);
    std::vector<Span> later, earlier;
    for (const Span& span : spans_) {
        if (span.beginNs < untilNs) earlier.push_back({span.kind, span.beginNs, std::min(span.endNs, untilNs)});
        if (span.endNs > untilNs) later.push_back({span.kind, std::max(span.beginNs, untilNs), span.endNs});
    }
    spans_.assign(later.begin(), later.end());
    return earlier;
}

} // namespace mural
