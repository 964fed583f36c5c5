#include "nodes/overlay/frame_parts.hpp"

#include <numeric>
#include <optional>

namespace mural {

namespace {

// Spans of programs, and of the head's own work, belong to no node.
std::optional<FramePart> partOf(SpanKind kind, bool countsWaits) {
    switch (kind) {
    case SpanKind::Decode: return FramePart::Decode;
    case SpanKind::Replay: return FramePart::Replay;
    case SpanKind::Readback: return FramePart::Readback;
    case SpanKind::Compose: return FramePart::Compose;
    case SpanKind::Compress: return FramePart::Compress;
    case SpanKind::Transfer: return FramePart::Transfer;
    case SpanKind::Assemble: return FramePart::Assemble;
    case SpanKind::Present: return FramePart::Present;
    case SpanKind::Receive: return countsWaits ? std::optional(FramePart::Decode) : std::nullopt;
    default: break;
    }
    return wire::isWait(kind) && countsWaits ? std::optional(FramePart::Wait) : std::nullopt;
}

} // namespace

double FrameParts::totalMs() const { return std::accumulate(ms.begin(), ms.end(), 0.0); }

void addParts(FrameParts& parts, std::span<const Span> spans, bool countsWaits) {
    for (const Span& span : spans)
        if (const auto part = partOf(span.kind, countsWaits))
            parts.ms[static_cast<size_t>(*part)] += static_cast<double>(span.ns()) / 1e6;
}

void FrameHistory::add(const FrameParts& frame) {
    if (frames_.size() >= kFrames) frames_.pop_front();
    frames_.push_back(frame);
}

double FrameHistory::framesPerSecond() const {
    int64_t firstNs = 0, lastNs = 0;
    size_t known = 0;
    for (const FrameParts& frame : frames_) {
        if (frame.endNs == 0) continue;
        if (known++ == 0) firstNs = frame.endNs;
        lastNs = frame.endNs;
    }
    return known < 2 || lastNs <= firstNs
               ? 0
               : static_cast<double>(known - 1) * 1e9 / static_cast<double>(lastNs - firstNs);
}

double FrameHistory::meanMs(FramePart part) const {
    if (frames_.empty()) return 0;
    double sum = 0;
    for (const FrameParts& frame : frames_) sum += frame.ms[static_cast<size_t>(part)];
    return sum / static_cast<double>(frames_.size());
}

} // namespace mural
