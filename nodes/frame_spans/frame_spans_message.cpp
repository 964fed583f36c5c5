#include "nodes/frame_spans/frame_spans_message.hpp"

#include <array>
#include <cstdint>

namespace mural {

void addSpans(std::vector<wire::FrameSpan>& message, wire::SpanThread thread, const std::vector<Span>& spans) {
    for (const Span& span : spans)
        if (message.size() < wire::kMaxFrameSpans)
            message.push_back(
                {static_cast<uint32_t>(span.kind), static_cast<uint32_t>(thread), span.beginNs, span.endNs});
}

std::vector<Span> spansOf(std::span<const wire::FrameSpan> message, wire::SpanThread thread) {
    std::vector<Span> spans;
    for (const wire::FrameSpan& span : message)
        if (span.thread == static_cast<uint32_t>(thread))
            spans.push_back({static_cast<SpanKind>(span.kind), span.beginNs, span.endNs});
    return spans;
}

Result<void> checkSpans(std::span<const wire::FrameSpan> message) {
    std::array<int64_t, wire::kSpanThreads> ends;
    ends.fill(INT64_MIN);
    for (const wire::FrameSpan& span : message) {
        if (span.kind >= wire::kSpanKinds || span.thread >= wire::kSpanThreads)
            return Error{"it sent statistics of an unknown kind; install the same version of mural on all machines"};
        if (!wire::isSensibleTime(span.beginNs) || !wire::isSensibleTime(span.endNs) ||
            span.beginNs < ends[span.thread] || span.endNs < span.beginNs)
            return Error{"it sent statistics whose times overlap, or are out of range"};
        ends[span.thread] = span.endNs;
    }
    return {};
}

} // namespace mural
