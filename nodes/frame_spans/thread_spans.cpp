#include "nodes/frame_spans/thread_spans.hpp"

#include <algorithm>
#include <span>
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

// Replaces neighbours that are short by one wait and one activity, with their total times: sums stay right, and only
// the order among the short ones is lost.
void appendSums(std::vector<Span>& spans, std::span<const Span> neighbours) {
    Span wait, work; // the longest of each
    int64_t waitNs = 0, workNs = 0;
    for (const Span& span : neighbours) {
        Span& longest = wire::isWait(span.kind) ? wait : work;
        (wire::isWait(span.kind) ? waitNs : workNs) += span.ns();
        if (span.ns() > longest.ns()) longest = span;
    }
    const int64_t beginNs = neighbours.front().beginNs;
    append(spans, {wait.kind, beginNs, beginNs + waitNs}, 0);
    append(spans, {work.kind, beginNs + waitNs, beginNs + waitNs + workNs}, 0);
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

// Halves the number of spans, the shortest ones first.
void ThreadSpans::coarsen() {
    constexpr size_t kMostNeighbours = 8;
    for (int64_t minNs = 2 * kMinNs; spans_.size() > kMaxSpans / 2; minNs *= 2) {
        std::vector<Span> fewer;
        fewer.reserve(kMaxSpans + 1);
        for (size_t from = 0; from < spans_.size();) {
            size_t end = from;
            while (end < spans_.size() && end - from < kMostNeighbours && spans_[end].ns() < minNs) ++end;
            if (end - from > 2)
                appendSums(fewer, std::span(spans_).subspan(from, end - from));
            else
                for (end = std::max(end, from + 1); const Span& span : std::span(spans_).subspan(from, end - from))
                    append(fewer, span, 0);
            from = end;
        }
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
