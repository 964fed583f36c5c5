// The message with a node's spans of one frame. Pure.
#pragma once

#include <span>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/frame_spans/thread_spans.hpp"
#include "streamcodec/wire/frame_spans.hpp"

namespace mural {

// Adds the spans of one thread. Spans above the limit of a message are dropped.
void addSpans(std::vector<wire::FrameSpan>& message, wire::SpanThread thread, const std::vector<Span>& spans);

// Returns the spans of a thread.
std::vector<Span> spansOf(std::span<const wire::FrameSpan> message, wire::SpanThread thread);

// Errors: an unknown kind or thread; spans of a thread that overlap, or end before they begin.
Result<void> checkSpans(std::span<const wire::FrameSpan> message);

} // namespace mural
