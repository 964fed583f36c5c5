// Marks an activity or a wait of the current thread, for the statistics of frames. Without statistics it costs a read
// of a thread-local variable.
#pragma once

#include "common/base/quick_clock.hpp"
#include "nodes/frame_spans/thread_spans.hpp"

namespace mural {

// The spans of the current thread. Null: the thread records none. Set by the thread itself.
inline thread_local ThreadSpans* currentSpans = nullptr;

class SpanScope {
public:
    explicit SpanScope(SpanKind kind) : spans_(currentSpans) {
        if (spans_) outer_ = spans_->enter(kind, quickNowNs());
    }
    ~SpanScope() {
        if (spans_) spans_->enter(outer_, quickNowNs());
    }
    SpanScope(const SpanScope&) = delete;
    SpanScope& operator=(const SpanScope&) = delete;

private:
    ThreadSpans* const spans_;
    SpanKind outer_ = SpanKind::Replay;
};

// Makes `spans` the spans of this thread, or ends them. `idle`: the state of the thread outside of all scopes.
inline void recordThread(ThreadSpans& spans, bool isOn, SpanKind idle) {
    if (isOn && !spans.isActive()) spans.start(idle, quickNowNs());
    if (!isOn) spans.stop();
    currentSpans = isOn ? &spans : nullptr;
}

} // namespace mural
