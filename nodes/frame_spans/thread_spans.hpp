// The activities and waits of one thread, as consecutive spans of time. Pure: the caller passes the time.
//
// A thread is in exactly one state at a time, so its spans do not overlap and leave no gap. Memory is bounded: many
// short spans become fewer longer ones. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "streamcodec/wire/frame_spans.hpp"

namespace mural {

using wire::SpanKind;

struct Span {
    SpanKind kind = SpanKind::Replay;
    int64_t beginNs = 0;
    int64_t endNs = 0;

    [[nodiscard]] int64_t ns() const { return endNs - beginNs; }
    bool operator==(const Span&) const = default;
};

class ThreadSpans {
public:
    static constexpr size_t kMaxSpans = 128; // kept between two calls of take()
    static constexpr int64_t kMinNs = 2'000; // a shorter span belongs to its predecessor

    // Begins to record, with the thread in this state. Without effect if it records already.
    void start(SpanKind kind, int64_t nowNs);
    void stop() { isActive_ = false; }
    [[nodiscard]] bool isActive() const { return isActive_; }

    // Changes the state of the thread. Returns the earlier one. Without effect before start().
    SpanKind enter(SpanKind kind, int64_t nowNs);

    // Returns the spans since the last call, up to this time. Later spans stay for the next call.
    [[nodiscard]] std::vector<Span> take(int64_t untilNs);

private:
    void close(int64_t nowNs);
    void coarsen();

    bool isActive_ = false;
    SpanKind kind_ = SpanKind::Replay; // the current state…
    int64_t sinceNs_ = 0;              // …and its begin
    std::vector<Span> spans_;          // completed
};

} // namespace mural
